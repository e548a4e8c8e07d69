// Plays recorded runs. Each .run-player contains a run as JSON, and gets a canvas, buttons and a time line for each rule.
const SPEEDS = [0.25, 0.5, 1, 2, 4];
const HELP = "Keys work while the mouse is here. Space plays and pauses. The arrow keys move by 0.1 s, with Shift by 1 s. Home and End go "
  + "to the ends. B goes to the instant at which a rule broke. L goes to the next line of the log, with Shift to the one before. "
  + "+ and \u2212 zoom, as the mouse wheel with Ctrl and two fingers do, 0 shows all, and F follows a robot. Drag to move what is "
  + "zoomed. The dashed line in front of the robot is the way of the next 2 s, if the robot obeys the newest command.";

const start = async root => {
  root.classList.add("run-starting");
  const run = await unpackRun(JSON.parse(root.querySelector("script[type='application/json']").textContent));
  const begin = run.times[0], end = run.times[run.times.length - 1];
  const broken = run.margins.map(margin => margin.broken).filter(time => time !== null);
  const chosen = run.moment && run.moment.marked ? run.moment.time : broken.length ? Math.min(...broken) : null;
  const stage = make("div", {class: "run-stage"}, root), head = make("div", {class: "run-head"}, stage);
  const title = make("p", {class: "run-title"}, head);
  make("strong", {text: run.title}, title);
  make("span", {text: run.summary}, title);
  const viewing = make("div", {class: "run-view", role: "group", "aria-label": "View"}, head);
  const canvas = make("canvas", {role: "img", tabindex: "0", "aria-label": run.alt}, stage);
  const form = make("form", {class: "run-row"}, stage);
  const button = make("button", {type: "button", class: "run-play", text: "Play"}, form);
  const slider = make("input", {type: "range", min: begin, max: end, step: "any", "aria-label": "Time in seconds"}, form);
  const clock = make("output", {}, form);
  const speed = make("select", {"aria-label": "Speed"}, form);
  for (const factor of SPEEDS) make("option", {value: factor, text: `${factor}\u00d7`}, speed);
  speed.value = SPEEDS.includes(Number(root.dataset.speed)) ? root.dataset.speed : "1";
  const link = window === window.top && !root.closest(".jp-Notebook")
    ? make("a", {text: "Link to this instant", href: "#"}, form) : null;
  let now = chosen === null ? end : Math.min(end, Math.max(begin, chosen)), playing = false, before = null, palette = {};
  const show = time => { setPlaying(false); now = Math.min(end, Math.max(begin, time)); draw(); };
  const readout = makeReadout(stage, run);
  const lists = run.margins.map(margin => makeMargin(stage, margin, begin, end, show));
  if (run.said.length) lists.push(makeLog(stage, run.said, show));
  const help = make("details", {}, stage);
  make("summary", {text: "Keys"}, help);
  make("span", {text: HELP}, help);

  const styles = getComputedStyle(root);
  const colour = name => palette[name] ??= styles.getPropertyValue(`--run-${name}`).trim();
  const draw = () => {
    const row = Math.max(0, last(run.times, now));
    clock.textContent = `${now.toFixed(2)} s`;
    slider.value = now;
    readout(now, row);
    if (link) link.href = `#${new URLSearchParams({...(root.id && {run: root.id}), t: now.toFixed(2)})}`;
    lists.forEach(update => update(now));
    view.show(now, row);
    const name = view.following();
    following.textContent = name === null || run.robots.length === 1 ? "Follow" : `Follow: ${name}`;
    following.setAttribute("aria-pressed", name !== null);
  };
  const view = makeView(stage, canvas, run, colour, () => draw());
  const addButton = (text, label, action) => {
    const added = make("button", {type: "button", text, ...(label && {"aria-label": label, title: label})}, viewing);
    added.addEventListener("click", action);
    return added;
  };
  addButton("\u2212", "Zoom out", () => view.zoomAt(1 / 1.5));
  addButton("+", "Zoom in", () => view.zoomAt(1.5));
  addButton("All", "Show the whole world", view.whole);
  const following = addButton("Follow", "", view.follow);
  const resize = () => { palette = {}; view.resize(); draw(); };

  const frame = stamp => {
    if (!playing) return;
    now = Math.min(end, now + (before === null ? 0 : Number(speed.value) * (stamp - before) / 1000));
    before = stamp;
    draw();
    if (now >= end) setPlaying(false); else requestAnimationFrame(frame);
  };
  const setPlaying = value => {
    playing = value;
    before = null;
    button.textContent = playing ? "Pause" : "Play";
    if (playing) { if (now >= end) now = begin; requestAnimationFrame(frame); }
  };
  const nextLine = back => {
    const times = run.said.map(([time]) => time).filter(time => back ? time < now - 1e-3 : time > now + 1e-3);
    if (times.length) show(back ? times[times.length - 1] : times[0]);
  };
  const keys = {
    " ": () => setPlaying(!playing), Home: () => show(begin), End: () => show(end),
    ArrowLeft: event => show(now - (event.shiftKey ? 1 : 0.1)), ArrowRight: event => show(now + (event.shiftKey ? 1 : 0.1)),
    l: () => nextLine(false), L: () => nextLine(true),
    b: () => { if (broken.length) show(Math.min(...broken)); },
    "+": () => view.zoomAt(1.5), "=": () => view.zoomAt(1.5), "-": () => view.zoomAt(1 / 1.5), "0": view.whole, f: view.follow,
  };
  // A key is for the player below the mouse, unless the focus is in a text field elsewhere. Otherwise it is for the player
  // with the focus, or for the only one of a page.
  const isMine = target => {
    const inside = target.closest(".run-player");
    if (!inside && (target.isContentEditable || target.closest("input, textarea, select"))) return false;
    return (document.querySelector(".run-player:hover") || inside || document.querySelector(".run-player[data-alone]")) === root;
  };
  window.addEventListener("keydown", event => { // the window receives a key before a notebook does
    const {target} = event;
    if (!root.isConnected || !(target instanceof Element) || !keys[event.key] || !isMine(target)) return;
    const press = target.closest("button, a, summary") && event.key === " ";
    if (press || target.closest("select") || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    keys[event.key](event);
  }, true);
  if (window !== window.top) root.addEventListener("pointerenter", () => window.focus()); // otherwise a frame receives no keys
  button.addEventListener("click", () => setPlaying(!playing));
  form.addEventListener("submit", event => event.preventDefault());
  slider.addEventListener("input", () => show(Number(slider.value)));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", resize);
  root.classList.add("run-ready");
  let wide = 0; // only a new width needs a redraw, not the height, which a longer readout increases
  new ResizeObserver(() => { if (stage.clientWidth !== wide) { wide = stage.clientWidth; resize(); } }).observe(stage);
  resize();

  const followLink = () => {
    const wanted = new URLSearchParams(location.hash.slice(1)), time = parseFloat(wanted.get("t"));
    const first = document.querySelector(".run-player[data-first]") || document.querySelector(".run-player");
    if (!Number.isFinite(time) || (wanted.has("run") ? wanted.get("run") !== root.id : root !== first)) return;
    for (let box = root.closest("details"); box; box = box.parentElement.closest("details")) box.open = true;
    show(time);
    root.scrollIntoView();
  };
  if (link) { window.addEventListener("hashchange", followLink); followLink(); }
  // Play once, when the run becomes visible for the first time. A run that broke a rule shows that instant instead.
  if (!root.dataset.play || chosen !== null || matchMedia("(prefers-reduced-motion: reduce)").matches) return;
  new IntersectionObserver(([seen], observer) => {
    if (!seen.isIntersecting) return;
    observer.disconnect();
    setPlaying(true);
  }, {threshold: 0.5}).observe(canvas);
};

for (const root of document.querySelectorAll(".run-player:not(.run-starting)")) start(root);
