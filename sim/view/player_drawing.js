// Draws an instant of a run with the styles in LOOK. Coordinates are in metres, and `dot` is the size of a page's pixel
// in metres. The run contains what does not change: the world, and each robot's name, shape and lidar. An instant contains
// the time, the collisions until then, the positions of moving obstacles, and each robot's state:
// {pose, velocity, command, isObeying, gap, met, scan: {pose, ranges}}.
const POINT = 4 / 3; // pixels
const AHEAD = 2; // s: the duration of the path that is drawn for the latest command
const MET_SECONDS = 1; // s: the duration for which a robot shows a collision
const MAX_GAP = 999; // m: larger gaps mean that there is no obstacle

// Returns the number of a robot's colours: 0 for the first robot, and the others take turns.
const kindOf = index => index && 1 + (index - 1) % LOOK.others;
const line = points => { const path = new Path2D(); points.forEach(([x, y]) => path.lineTo(x, y)); return path; };
const loop = points => { const path = line(points); path.closePath(); return path; };
const disc = (x, y, radius, path = new Path2D()) => {
  path.moveTo(x + radius, y);
  path.arc(x, y, radius, 0, 2 * Math.PI);
  return path;
};
const cross = (x, y, radius, path) => {
  for (const side of [-1, 1]) { path.moveTo(x - radius, y - side * radius); path.lineTo(x + radius, y + side * radius); }
};

// A sheet collects shapes, and draws the lowest layer first. `place` converts metres to pixels.
const makeSheet = (pen, colour, dot, place) => {
  const marks = [];
  const ink = (name, own) => name === "own" ? own : colour(name);
  const drawPath = ({mark, path, own}) => {
    if (mark.fill) { pen.fillStyle = ink(mark.fill, own); pen.fill(path); }
    if (!mark.line) return;
    pen.lineWidth = mark.width * POINT * dot;
    pen.setLineDash(mark.dash.map(part => part * pen.lineWidth));
    pen.strokeStyle = ink(mark.line, own);
    pen.stroke(path);
  };
  const drawWords = ({mark, words, spot, by, align, angle, fill}) => {
    const [x, y] = place(...spot);
    pen.save();
    pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    pen.translate(x + by[0] * POINT, y + by[1] * POINT);
    pen.rotate(-angle);
    pen.font = `${mark.size * POINT}px system-ui, sans-serif`;
    [pen.textAlign, pen.textBaseline, pen.lineJoin, pen.lineWidth] = [align, "middle", "round", mark.width * POINT];
    [pen.strokeStyle, pen.fillStyle] = [colour(mark.line || "paper"), colour(fill || mark.fill)];
    pen.setLineDash([]);
    words.split("\n").forEach((text, number) => {
      const where = [text, 0, 1.35 * number * mark.size * POINT];
      if (mark.line) pen.strokeText(...where);
      pen.fillText(...where);
    });
    pen.restore();
  };
  return {
    colour, dot,
    radius: name => LOOK.marks[name].size * POINT * dot / 2,
    add: (name, path, own = "") => marks.push({mark: LOOK.marks[name], path, own}),
    // Writes words at a place in metres, moved `by` points right and down, and turned to the left by an angle in radians.
    write: (words, spot, by, align, {name = "words", angle = 0, fill = ""} = {}) =>
      marks.push({mark: LOOK.marks[name], words, spot, by, align, angle, fill}),
    draw: () => {
      [pen.lineCap, pen.lineJoin] = ["round", "round"];
      marks.sort((one, other) => one.mark.layer - other.mark.layer);
      for (const each of marks) {
        pen.globalAlpha = each.mark.alpha;
        if (each.path) drawPath(each); else drawWords(each);
      }
      pen.globalAlpha = 1;
    },
  };
};

const reach = robot => Math.max(...robot.body.map(([x, y]) => Math.hypot(x, y)));

// Draws what does not move: room, furniture, walls, goals, starts, the routes of moving obstacles, and names.
const makeWorld = run => {
  const {world} = run, parts = [["floor", loop(world.room)]], walls = new Path2D();
  for (const points of world.solid) parts.push(["solid", loop(points)]);
  for (const [x1, y1, x2, y2] of world.walls) { walls.moveTo(x1, y1); walls.lineTo(x2, y2); }
  parts.push(["wall", walls]);
  for (const [x, y, size] of world.pillars) parts.push(["pillar", disc(x, y, size)]);
  for (const [x, y, size] of world.goals)
    parts.push(["goal", disc(x, y, size)], ["goal ring", disc(x, y, size)], ["goal middle", disc(x, y, LOOK.middle * size)]);
  const radius = reach(run.robots[0]);
  for (const [x, y, turn] of world.starts) {
    const ahead = [1, LOOK.pointer].map(far => [x + far * radius * Math.cos(turn), y + far * radius * Math.sin(turn)]);
    parts.push(["start", disc(x, y, radius)], ["start nose", line(ahead)]);
  }
  for (const points of world.routes) parts.push(["route", line(points)]);
  return sheet => {
    parts.forEach(([name, path]) => sheet.add(name, path));
    for (const {text, x, y, right, up, angle, colour} of run.names || [])
      sheet.write(text, [x, y], [right, -up], "center", {name: "name", angle, fill: colour});
  };
};

// Draws a scan with the lidar's geometry. A range below 0 has no return, and 0 is no reading.
const drawScan = (sheet, lidar, {pose: [x, y, turn], ranges}) => {
  const [mx, my, mturn] = lidar.mount;
  const cx = x + Math.cos(turn) * mx - Math.sin(turn) * my, cy = y + Math.sin(turn) * mx + Math.cos(turn) * my;
  const every = Math.max(1, Math.round(ranges.length / LOOK.beams));
  const seen = new Path2D(), rays = new Path2D(), hits = new Path2D(), size = sheet.radius("hit");
  if (!lidar.full) seen.moveTo(cx, cy);
  ranges.forEach((range, beam) => {
    const angle = turn + mturn + lidar.first + beam * lidar.turn, length = range < 0 ? lidar.reach : range;
    const end = [cx + length * Math.cos(angle), cy + length * Math.sin(angle)];
    seen.lineTo(...end);
    if (range <= 0) return;
    disc(...end, size, hits);
    if (beam % every === 0) { rays.moveTo(cx, cy); rays.lineTo(...end); }
  });
  sheet.add("seen", seen);
  sheet.add("ray", rays);
  sheet.add("hit", hits);
};

const channel = (colour, place) => parseInt(colour.slice(1 + 2 * place, 3 + 2 * place), 16);
const mixed = (one, other, share) =>
  `rgb(${[0, 1, 2].map(place => Math.round((1 - share) * channel(one, place) + share * channel(other, place)))})`;
// The robot's colour, light at the start and dark at the end.
const hue = (colour, kind, share) => share < 0.5 ? mixed(colour(`early${kind}`), colour(`own${kind}`), 2 * share)
  : mixed(colour(`own${kind}`), colour(`late${kind}`), 2 * share - 1);

// Divides `rows` steps of a track into pieces, each of one colour: the first and the last row of each.
const pieces = rows => Array.from({length: LOOK.pieces}, (_, number) =>
  [number, number + 1].map(cut => Math.round(cut * rows / LOOK.pieces)));

// The text of the collision that a robot shows at an instant, or "".
const metAt = (collisions, name, now) => {
  const met = collisions.filter(([when, , , , who = name]) => who === name && when <= now + 1e-6 && now - when < MET_SECONDS);
  return met.length ? met[met.length - 1][3] : "";
};

const drawRobot = (sheet, run, robot, kind, state) => {
  const [x, y, turn] = state.pose, own = sheet.colour(`own${kind}`);
  if (state.command && state.isObeying) { // draw the way of the latest command
    const [linear, angular] = state.command, way = [];
    for (let px = x, py = y, angle = turn, at = 0; at <= AHEAD; at += 0.05) {
      way.push([px, py]);
      px += 0.05 * linear * Math.cos(angle); py += 0.05 * linear * Math.sin(angle); angle += 0.05 * angular;
    }
    sheet.add("way ahead", line(way));
  }
  const placed = points => loop(points.map(([px, py]) =>
    [x + Math.cos(turn) * px - Math.sin(turn) * py, y + Math.sin(turn) * px + Math.cos(turn) * py]));
  sheet.add("halo", disc(x, y, sheet.radius("halo")), own);
  sheet.add("body", placed(robot.body), state.met ? sheet.colour("alarm") : own);
  sheet.add("nose", placed(robot.nose));
  if (run.robots.length > 1) sheet.write(robot.name, [x, y + reach(robot)], [0, -8], "center");
};

const drawCollisions = (sheet, {time, collisions}) => {
  for (const name of ["collision halo", "collision"]) {
    const path = new Path2D();
    for (const [when, x, y] of collisions) if (when <= time + 1e-6) cross(x, y, sheet.radius(name), path);
    sheet.add(name, path);
  }
};

// Draws the nearest approach of the run, or the chosen instant: its line to the nearest obstacle, and its text.
const drawMoment = (sheet, run, now) => {
  const {moment} = run;
  if (!moment) return;
  const {at, near, marked} = moment, between = marked ? "gap" : "closest";
  if (near) {
    sheet.add(between, line([at, near]));
    sheet.add(`${between} end`, disc(...near, sheet.radius(`${between} end`)));
  }
  if (!marked) return sheet.write(moment.words, moment.spot, [7, 0], "left");
  sheet.add("instant", disc(...at, sheet.radius("instant")));
  const [left, low, right, high] = run.world.bounds, side = at[0] > (left + right) / 2 ? -1 : 1;
  if (Math.abs(now - moment.time) < 0.06)
    sheet.write(moment.words, at, [18 * side, at[1] > (low + high) / 2 ? 24 : -30], side > 0 ? "left" : "right");
};

// Returns a function that draws an instant on a sheet. `addTrack(sheet, index, kind, instant)` draws a robot's track.
const makeScene = (run, addTrack) => {
  const kinds = run.robots.map((_, index) => kindOf(index)), addWorld = makeWorld(run);
  return (sheet, instant) => {
    addWorld(sheet);
    run.robots.forEach(({scans}, index) => {
      const {scan} = instant.robots[index];
      if (scan) drawScan(sheet, scans, scan);
    });
    run.world.movers.forEach((radius, index) => sheet.add("mover", disc(...instant.movers[index], radius)));
    kinds.forEach((kind, index) => addTrack(sheet, index, kind, instant));
    run.robots.forEach((robot, index) => drawRobot(sheet, run, robot, kinds[index], instant.robots[index]));
    drawCollisions(sheet, instant);
    drawMoment(sheet, run, instant.time);
  };
};
