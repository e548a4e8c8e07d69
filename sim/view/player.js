// Plays recorded runs. Each .run-player contains a run as JSON, and gets a canvas, buttons and a time line for each rule.
const HELP = "Keys work while the mouse is here. Space plays and pauses. The arrow keys move by 0.1 s, with Shift by 1 s. Home and End go "
  + "to the ends. B goes to the instant at which a rule broke. L goes to the next line of the log, with Shift to the one before. ";

const start = async root => {
  root.classList.add("run-starting");
  const run = await unpackRun(JSON.parse(root.querySelector("script[type='application/json']").textContent));
  const begin = run.times[0], end = run.times[run.times.length - 1];
  const broken = run.margins.map(margin => margin.broken).filter(time => time !== null);
  const chosen = run.moment && run.moment.marked ? run.moment.time : broken.length ? Math.min(...broken) : null;
  const draw = () => {
    const instant = instantOf(run, now);
    slider.value = now;
    readout(instant);
    if (link) link.href = `#${new URLSearchParams({...(root.id && {run: root.id}), t: now.toFixed(2)})}`;
    lists.forEach(update => update(now));
    panel.show(instant);
  };
  const panel = makePanel(root, run, Number(root.dataset.speed ?? 1), makeScene(run, makeTracks(run)), () => draw());
  const {stage, form, button, slider, speed} = panel;
  [slider.min, slider.max] = [begin, end];
  const link = window === window.top && !root.closest(".jp-Notebook")
    ? make("a", {text: "Link to this instant", href: "#"}, form) : null;
  let now = chosen === null ? end : Math.min(end, Math.max(begin, chosen)), playing = false, before = null;
  const show = time => { setPlaying(false); now = Math.min(end, Math.max(begin, time)); draw(); };
  const readout = makeReadout(stage, run);
  const lists = run.margins.map(margin => makeMargin(stage, margin, begin, end, show));
  if (run.said.length) lists.push(makeLog(stage, run.said, show));
  panel.addHelp(HELP);

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
  };
  listenToKeys(root, {...panel.keys, ...keys});
  button.addEventListener("click", () => setPlaying(!playing));
  slider.addEventListener("input", () => show(Number(slider.value)));
  root.classList.add("run-ready");
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", panel.fit(available => panel.view.resize(available)));

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
  }, {threshold: 0.5}).observe(panel.pictures);
};

for (const root of document.querySelectorAll(".run-player:not(.run-starting)")) start(root);
