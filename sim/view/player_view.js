// The part of the world that a canvas shows: axes in metres, zoom, pan, and following a robot. It handles the mouse and
// fingers itself, and calls `changed` after a change. `draw(sheet, instant)` draws an instant.
const EDGE = {left: 42, right: 8, top: 4, bottom: 20}; // pixels around the world, for the axes
const MIN_SPACING = 26; // the minimum number of pixels between two lines of the grid
const MAX_ZOOM = 20; // the maximum zoom factor
const FOLLOWING_ZOOM = 3; // the zoom factor for following, if the whole world was shown

const makeView = (canvas, run, colour, draw, changed) => {
  const [left, low, right, high] = run.world.bounds, [innerLeft, innerLow, innerRight, innerHigh] = run.world.inside;
  const pen = canvas.getContext("2d"), fingers = new Map();
  let width = 0, height = 0, zoom = 1, x = (left + right) / 2, y = (low + high) / 2, followed = -1;

  const scale = () => zoom * width / (right - left);
  const place = (mx, my) => [EDGE.left + width / 2 + (mx - x) * scale(), EDGE.top + height / 2 - (my - y) * scale()];
  const within = (value, from, to) => Math.min(to, Math.max(from, value));
  const settle = () => {
    const wide = (right - left) / zoom / 2, tall = (high - low) / zoom / 2;
    [x, y] = [within(x, left + wide, right - wide), within(y, low + tall, high - tall)];
    canvas.style.touchAction = zoom > 1 ? "none" : "pan-y";
    canvas.style.cursor = zoom > 1 ? "grab" : "";
  };
  // Zooms by a factor around the point (px, py) of the canvas, in pixels.
  const zoomAt = (factor, px = EDGE.left + width / 2, py = EDGE.top + height / 2) => {
    const before = scale(), [dx, dy] = [px - EDGE.left - width / 2, py - EDGE.top - height / 2];
    zoom = within(zoom * factor, 1, MAX_ZOOM);
    if (followed < 0) [x, y] = [x + dx / before - dx / scale(), y - dy / before + dy / scale()];
    settle();
    changed();
  };
  const whole = () => { [zoom, followed] = [1, -1]; settle(); changed(); };
  const follow = () => {
    followed = (followed + 2) % (run.robots.length + 1) - 1;
    if (followed >= 0 && zoom === 1) zoom = FOLLOWING_ZOOM;
    settle();
    changed();
  };

  const ticks = (from, to, step) => {
    const first = Math.ceil(from / step - 1e-9), count = Math.floor(to / step + 1e-9) - first + 1;
    return Array.from({length: Math.max(0, count)}, (_, number) => (first + number) * step);
  };
  // Returns the positions of the grid's lines, across and up.
  const axes = () => {
    const extent = Math.max(innerRight - innerLeft, innerHigh - innerLow) / zoom;
    const [step] = LOOK.grid.find(([size, most]) => extent <= most && size * scale() >= MIN_SPACING) || LOOK.grid[LOOK.grid.length - 1];
    const wide = (right - left) / zoom / 2, tall = (high - low) / zoom / 2;
    return [ticks(Math.max(innerLeft, x - wide), Math.min(innerRight, x + wide), step),
      ticks(Math.max(innerLow, y - tall), Math.min(innerHigh, y + tall), step)];
  };
  const write = ([across, up]) => {
    pen.font = `${LOOK.marks.words.size * POINT}px system-ui, sans-serif`;
    pen.fillStyle = colour("muted");
    const label = (list, number) => Number(list[number].toFixed(2)) + (number === list.length - 1 ? " m" : "");
    [pen.textAlign, pen.textBaseline] = ["center", "top"];
    across.forEach((tick, number) => pen.fillText(label(across, number), place(tick, y)[0], EDGE.top + height + 5));
    [pen.textAlign, pen.textBaseline] = ["right", "middle"];
    up.forEach((tick, number) => pen.fillText(label(up, number), EDGE.left - 4, place(x, tick)[1]));
  };

  const show = instant => {
    if (!width) return;
    if (followed >= 0) { [x, y] = instant.robots[followed].pose; settle(); }
    const ratio = devicePixelRatio, [ox, oy] = place(0, 0), [across, up] = axes();
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    write([across, up]);
    pen.save();
    pen.beginPath();
    pen.rect(EDGE.left, EDGE.top, width, height);
    pen.clip();
    pen.fillStyle = colour("outside");
    pen.fillRect(EDGE.left, EDGE.top, width, height);
    pen.setTransform(ratio * scale(), 0, 0, -ratio * scale(), ratio * ox, ratio * oy);
    const sheet = makeSheet(pen, colour, 1 / scale(), place), grid = new Path2D();
    for (const tick of across) { grid.moveTo(tick, low); grid.lineTo(tick, high); }
    for (const tick of up) { grid.moveTo(left, tick); grid.lineTo(right, tick); }
    sheet.add("grid", grid);
    draw(sheet, instant);
    sheet.draw();
    pen.restore();
  };
  // Uses the available width in pixels, and the height of the world, at most a share of the window's. Returns the height.
  const resize = (available, share = 0.7) => {
    const shape = (high - low) / (right - left);
    width = Math.max(0, Math.min(available - EDGE.left - EDGE.right, share * window.innerHeight / shape));
    height = width * shape;
    const size = [width + EDGE.left + EDGE.right, height + EDGE.top + EDGE.bottom];
    [canvas.style.width, canvas.style.height] = size.map(side => `${side}px`);
    [canvas.width, canvas.height] = size.map(side => Math.round(side * devicePixelRatio));
    settle();
    return size[1];
  };

  const at = event => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
  const apart = (one, other) => Math.hypot(one[0] - other[0], one[1] - other[1]) || 1;
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, at(event));
  });
  canvas.addEventListener("pointermove", event => {
    const from = fingers.get(event.pointerId), here = at(event);
    if (!from) return;
    const [other] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, spot]) => spot);
    fingers.set(event.pointerId, here);
    if (other) return zoomAt(apart(here, other) / apart(from, other), (here[0] + other[0]) / 2, (here[1] + other[1]) / 2);
    if (zoom === 1) return;
    followed = -1;
    [x, y] = [x - (here[0] - from[0]) / scale(), y + (here[1] - from[1]) / scale()];
    settle();
    changed();
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, event => fingers.delete(event.pointerId));
  canvas.addEventListener("dblclick", event => zoomAt(2, ...at(event)));
  canvas.addEventListener("wheel", event => { // without Ctrl, the wheel scrolls the page
    if (!event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    zoomAt(Math.exp(-event.deltaY / 300), ...at(event));
  }, {passive: false});
  return {show, resize, zoomAt, whole, follow, followed: () => followed};
};
