// What the player and the live view have in common: heading, buttons of the view, canvas, time line and keys.
const SPEEDS = [0.25, 0.5, 1, 2, 4];
const ZOOM_STEP = 1.5;
const VIEW_HELP = "+ and \u2212 zoom, as the mouse wheel with Ctrl and two fingers do, 0 shows all, and F follows a robot. Drag to move what "
  + "is zoomed. The dashed line in front of a robot is the way of the next 2 s, if the robot obeys the newest command.";

// Adds the parts to `root`. `factor` is the initial speed, `draw(sheet, instant)` draws an instant, and `redraw` shows the
// current one again.
const makePanel = (root, run, factor, draw, redraw) => {
  let palette = {};
  const styles = getComputedStyle(root), colour = name => palette[name] ??= styles.getPropertyValue(`--run-${name}`).trim();
  const stage = make("div", {class: "run-stage"}, root), head = make("div", {class: "run-head"}, stage);
  const title = make("p", {class: "run-title"}, head);
  make("strong", {text: run.title}, title);
  make("span", {text: run.summary}, title);
  const viewing = make("div", {class: "run-view", role: "group", "aria-label": "View"}, head);
  const pictures = make("div", {class: "run-pictures"}, stage);
  const canvas = make("canvas", {role: "img", tabindex: "0", "aria-label": run.alt}, pictures);
  const form = make("form", {class: "run-row"}, stage);
  const button = make("button", {type: "button", class: "run-play", text: "Play"}, form);
  const slider = make("input", {type: "range", step: "any", "aria-label": "Time in seconds"}, form);
  const clock = make("output", {}, form);
  const speed = make("select", {"aria-label": "Speed"}, form);
  for (const value of [...new Set([...SPEEDS, factor])].sort((one, other) => one - other))
    make("option", {value, text: `${value}\u00d7`}, speed);
  speed.value = factor;
  form.addEventListener("submit", event => event.preventDefault());

  const view = makeView(canvas, run, colour, draw, redraw);
  makeButton(viewing, "\u2212", "Zoom out", () => view.zoomAt(1 / ZOOM_STEP));
  makeButton(viewing, "+", "Zoom in", () => view.zoomAt(ZOOM_STEP));
  makeButton(viewing, "All", "Show the whole world", view.whole);
  const following = makeButton(viewing, "Follow", "", view.follow);
  const show = instant => {
    clock.textContent = `${instant.time.toFixed(2)} s`;
    view.show(instant);
    const index = view.followed();
    following.textContent = index < 0 || run.robots.length === 1 ? "Follow" : `Follow: ${run.robots[index].name}`;
    following.setAttribute("aria-pressed", index >= 0);
  };
  // Calls `resize` with the available width when it changes, but not when a longer readout increases the height. Returns a
  // function that does so in any case, and reads the colours again.
  const fit = resize => {
    let wide = 0;
    const update = () => { palette = {}; resize(stage.clientWidth); redraw(); };
    new ResizeObserver(() => { if (stage.clientWidth !== wide) { wide = stage.clientWidth; update(); } }).observe(stage);
    update();
    return update;
  };
  // Adds `text`, followed by the keys and gestures of the view.
  const addHelp = text => {
    const help = make("details", {}, stage);
    make("summary", {text: "Keys"}, help);
    make("span", {text: text + VIEW_HELP}, help);
  };
  const keys = {"+": () => view.zoomAt(ZOOM_STEP), "=": () => view.zoomAt(ZOOM_STEP), "-": () => view.zoomAt(1 / ZOOM_STEP),
    "0": view.whole, f: view.follow, F: view.follow};
  return {stage, pictures, form, button, slider, speed, view, colour, show, fit, addHelp, keys};
};

const makeButton = (parent, text, label, action) => {
  const added = make("button", {type: "button", text, ...(label && {"aria-label": label, title: label})}, parent);
  added.addEventListener("click", action);
  return added;
};

// Calls `keys[key](event)` for a key that belongs to the player or live view `root`: the one below the mouse, unless the focus
// is in a text field elsewhere. Otherwise it is the one with the focus, or the only one of a page. Returns a function that
// ends this.
const listenToKeys = (root, keys) => {
  const isMine = target => {
    const inside = target.closest(".run-player");
    if (!inside && (target.isContentEditable || target.closest("input, textarea, select"))) return false;
    return (document.querySelector(".run-player:hover") || inside || document.querySelector(".run-player[data-alone]")) === root;
  };
  const press = event => {
    const {target} = event;
    if (!root.isConnected || !(target instanceof Element) || !keys[event.key] || !isMine(target)) return;
    const isPressed = target.closest("button, a, summary") && event.key === " ";
    if (isPressed || target.closest("select") || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    keys[event.key](event);
  };
  window.addEventListener("keydown", press, true); // the window receives a key before a notebook does
  if (window !== window.top) root.addEventListener("pointerenter", () => window.focus()); // otherwise a frame receives no keys
  return () => window.removeEventListener("keydown", press, true);
};
