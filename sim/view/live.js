// The live view. The kernel simulates and sends a frame for each instant. The page draws it, and sends what buttons and keys
// ask for. Zoom and pan need no kernel.
const HELP = "Keys work while the mouse is here. Space plays and pauses, and a full stop simulates 0.1 s. ";
const DRIVE_HELP = "The arrow keys drive as the buttons do: until the next command. S stops the robot. ";
const SEEK_HELP = "The left and right arrow keys move by 0.1 s. ";
const PAD = [["\u21ba", "Turn left", 0, 1], ["\u2191", "Forward", 1, 0], ["\u2193", "Backward", -1, 0], ["\u21bb", "Turn right", 0, -1],
  ["\u25a0", "Stop the robot", 0, 0]];
const SMALL = 560; // pixels: in a narrower view, the scan is below the world
const SCAN = {min: 180, small: 220, share: 0.36}; // pixels, and the largest share of the width
const SHARE = 0.55; // of the window's height: the most that the world uses, so that the buttons are visible with it

// The kernel sends tables of numbers as bytes.
const numbersOf = ({buffer, byteOffset, byteLength}) => new Float32Array(buffer.slice(byteOffset, byteOffset + byteLength));
const instantOfFrame = (run, frame) => ({...frame, robots: frame.robots.map((robot, index) => ({...robot, isObeying: true,
  met: metAt(frame.collisions, run.robots[index].name, frame.time) || (robot.blocked ? "blocked" : ""),
  scan: robot.scan && {...robot.scan, ranges: numbersOf(robot.scan.ranges)}}))});

// Draws a robot's track until now, in pieces of one colour each.
const addDrivenTrack = (sheet, index, kind, {robots}) => {
  const {track, pose} = robots[index], numbers = numbersOf(track), points = [];
  for (let at = 0; at < numbers.length; at += 2) points.push([numbers[at], numbers[at + 1]]);
  points.push(pose);
  pieces(points.length - 1).forEach(([from, to], number, {length}) => {
    if (to > from) sheet.add("track", line(points.slice(from, to + 1)), hue(sheet.colour, kind, (number + 0.5) / length));
  });
};

const render = async ({model, el}) => {
  const root = make("div", {class: "run-player run-starting", "data-lm-suppress-shortcuts": "true"}, el);
  for (const [name, colour] of Object.entries(model.get("run").colours)) root.style.setProperty(`--run-${name}`, colour);
  const error = make("pre", {class: "run-error", role: "alert"}, root);
  const run = {...model.get("run"), moment: null, world: await unpackWorld(model.get("run").world)};
  const ask = (action, more = {}) => model.send({action, ...more});
  let instant = instantOfFrame(run, model.get("frame")), due = 0, wanted = null;
  const draw = () => {
    due = 0;
    slider.max = Math.max(instant.end, 0.1);
    if (!slider.matches(":active")) slider.value = instant.time;
    readout(instant);
    panel.show(instant);
    const index = Math.max(0, panel.view.followed());
    scan.show(index, kindOf(index), instant.robots[index]);
  };
  const panel = makePanel(root, run, model.get("speed"), makeScene(run, addDrivenTrack), () => draw());
  const {stage, pictures, form, button, slider, speed} = panel;
  const scan = makeScanView(make("canvas", {role: "img"}, pictures), run, panel.colour);
  button.after(makeButton(form, "Step", "Step by 0.1 s", () => ask("step")), ...(run.drivable
    ? [makeButton(form, "Reset", "Reset to the start", () => ask("reset"))] : []));
  speed.hidden = !run.paced;

  const drive = (forward, left) => ask("drive", {forward, left});
  const driver = make("output", {class: "run-driver"});
  if (run.drivable) {
    const pad = make("div", {class: "run-row", role: "group", "aria-label": "Drive"}, stage);
    for (const [text, label, forward, left] of PAD) makeButton(pad, text, label, () => drive(forward, left));
    if (run.releasable) makeButton(pad, "Let your code drive", "", () => ask("release"));
    pad.append(driver);
  }
  const readout = makeReadout(stage, run);
  panel.addHelp(HELP + (run.drivable ? DRIVE_HELP : SEEK_HELP));

  // A drag moves the slider more often than the kernel can answer, so each picture of the page asks for one instant.
  const seek = time => {
    if (wanted === null) requestAnimationFrame(() => { ask("seek", {time: wanted}); wanted = null; });
    wanted = time;
  };
  const toggle = () => ask(model.get("playing") ? "pause" : "play");
  const once = action => event => { if (!event.repeat) action(event); }; // not while a key is held
  const arrow = (forward, left, seconds) => once(({target}) => {
    if (run.drivable && target !== slider) drive(forward, left);
    else if (seconds) seek(instant.time + seconds);
  });
  const stop = once(() => { if (run.drivable) drive(0, 0); });
  const stopListening = listenToKeys(root, {...panel.keys, " ": once(toggle), ".": () => ask("step"), s: stop, S: stop,
    ArrowUp: arrow(1, 0, 0), ArrowDown: arrow(-1, 0, 0), ArrowLeft: arrow(0, 1, -0.1), ArrowRight: arrow(0, -1, 0.1)});
  button.addEventListener("click", toggle);
  slider.addEventListener("input", () => seek(Number(slider.value)));
  speed.addEventListener("change", () => ask("speed", {factor: Number(speed.value)}));

  const updates = {
    frame: () => { instant = instantOfFrame(run, model.get("frame")); due ||= requestAnimationFrame(draw); },
    playing: () => { button.textContent = model.get("playing") ? "Pause" : "Play"; },
    driver: () => { driver.textContent = model.get("driver"); },
    error: () => { error.textContent = model.get("error"); },
    speed: () => { speed.value = model.get("speed"); },
  };
  for (const [name, update] of Object.entries(updates)) { model.on(`change:${name}`, update); update(); }
  root.classList.add("run-ready");
  // The scan is as high as the world, within limits, so that there is no empty band below either.
  panel.fit(available => {
    const gap = 12, largest = SCAN.share * available;
    const height = panel.view.resize(available < SMALL ? available : available - largest - gap, SHARE);
    if (available < SMALL) return scan.resize(Math.min(available, SCAN.small));
    const side = Math.min(largest, Math.max(SCAN.min, height));
    panel.view.resize(available - side - gap, SHARE);
    scan.resize(side);
  });
  return () => {
    stopListening();
    for (const [name, update] of Object.entries(updates)) model.off(`change:${name}`, update);
  };
};

export default {render};
