// The newest scan in the robot's frame: x of base_link points up, with rings in metres and bearings in degrees.
const RINGS = [0.25, 0.5, 1, 2, 5, 10, 20]; // m: distances between two rings
const MAX_RINGS = 4;
const BEARINGS = [[0, "0\u00b0 x"], [90, "90\u00b0 y"], [180, "180\u00b0"], [-90, "\u221290\u00b0"]];

const makeScanView = (canvas, run, colour) => {
  const pen = canvas.getContext("2d"), [left, low, right, high] = run.world.inside;
  const half = Math.max(right - left, high - low) / 2;
  let size = 0;

  const addRings = (sheet, far) => {
    const apart = RINGS.find(step => far / step <= MAX_RINGS) ?? Infinity, lines = new Path2D();
    for (let ring = apart; ring <= far + 1e-9; ring += apart) {
      disc(0, 0, ring, lines);
      sheet.write(`${Number(ring.toFixed(2))} m`, [ring * Math.SQRT1_2, -ring * Math.SQRT1_2], [0, 0], "center", {name: "name"});
    }
    for (const [degrees, text] of BEARINGS) {
      const x = -Math.sin(degrees * Math.PI / 180), y = Math.cos(degrees * Math.PI / 180);
      lines.moveTo(0, 0);
      lines.lineTo(x * far, y * far);
      sheet.write(text, [1.1 * x * far, 1.1 * y * far], [0, 0], "center", {name: "name"});
    }
    sheet.add("grid", lines);
  };

  const show = (index, kind, {scan}) => {
    if (!size) return;
    const robot = run.robots[index], far = Math.min(robot.scans ? robot.scans.reach : 3, half), scale = size / (2.5 * far);
    canvas.setAttribute("aria-label", `The scan of ${robot.name} in its own frame, with x up`);
    pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    pen.clearRect(0, 0, size, size);
    const sheet = makeSheet(pen, colour, 1 / scale, (x, y) => [size / 2 + x * scale, size / 2 - y * scale]);
    pen.setTransform(devicePixelRatio * scale, 0, 0, -devicePixelRatio * scale, devicePixelRatio * size / 2, devicePixelRatio * size / 2);
    addRings(sheet, far);
    if (scan) drawScan(sheet, robot.scans, {pose: [0, 0, Math.PI / 2], ranges: scan.ranges});
    const upward = points => loop(points.map(([x, y]) => [-y, x]));
    sheet.add("body", upward(robot.body), sheet.colour(`own${kind}`));
    sheet.add("nose", upward(robot.nose));
    if (run.robots.length > 1) sheet.write(robot.name, [-1.2 * far, 1.1 * far], [0, 0], "left");
    sheet.draw();
  };
  const resize = side => {
    size = Math.max(0, side);
    [canvas.style.width, canvas.style.height] = [`${size}px`, `${size}px`];
    [canvas.width, canvas.height] = [size, size].map(length => Math.round(length * devicePixelRatio));
  };
  return {show, resize};
};
