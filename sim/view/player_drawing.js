// Draws a run with the styles in LOOK. Coordinates are in metres, and `dot` is the size of a page's pixel in metres.
const POINT = 4 / 3; // pixels
const AHEAD = 2; // s: the duration of the path that is drawn for the latest command
const MET_SECONDS = 1; // s: the duration for which a robot shows a collision

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
  const drawWords = ({mark, words, spot, by, align}) => {
    const [x, y] = place(...spot);
    pen.save();
    pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    pen.font = `${mark.size * POINT}px system-ui, sans-serif`;
    [pen.textAlign, pen.textBaseline, pen.lineJoin, pen.lineWidth] = [align, "middle", "round", mark.width * POINT];
    [pen.strokeStyle, pen.fillStyle] = [colour(mark.line), colour(mark.fill)];
    pen.setLineDash([]);
    words.split("\n").forEach((text, number) => {
      const where = [text, x + by[0] * POINT, y + (by[1] + 1.35 * number * mark.size) * POINT];
      pen.strokeText(...where);
      pen.fillText(...where);
    });
    pen.restore();
  };
  return {
    colour, dot,
    radius: name => LOOK.marks[name].size * POINT * dot / 2,
    add: (name, path, own = "") => marks.push({mark: LOOK.marks[name], path, own}),
    write: (words, spot, by, align) => marks.push({mark: LOOK.marks.words, words, spot, by, align}),
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

// Draws what does not move: room, furniture, walls, goals, starts, and the routes of moving obstacles.
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
  return sheet => parts.forEach(([name, path]) => sheet.add(name, path));
};

const drawScan = (sheet, robot, now) => {
  const {scans} = robot, number = scans ? last(scans.times, now) : -1;
  if (number < 0) return;
  const [x, y, turn] = scans.poses[number], [mx, my, mturn] = scans.mount;
  const cx = x + Math.cos(turn) * mx - Math.sin(turn) * my, cy = y + Math.sin(turn) * mx + Math.cos(turn) * my;
  const ranges = scans.ranges[number], every = Math.max(1, Math.round(ranges.length / LOOK.beams));
  const seen = new Path2D(), rays = new Path2D(), hits = new Path2D(), size = sheet.radius("hit");
  if (!scans.full) seen.moveTo(cx, cy);
  ranges.forEach((range, beam) => {
    const angle = turn + mturn + scans.first + beam * scans.turn, length = range < 0 ? scans.reach : range;
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

// Draws a track in pieces, each of one colour. The driven part is thick, the future part thin.
const makeTrack = (run, robot, kind) => {
  const rows = robot.poses.length - 1, whole = line(robot.poses), begin = run.times[0], span = run.times[rows] - begin || 1;
  const cuts = Array.from({length: LOOK.pieces + 1}, (_, number) => Math.round(number * rows / LOOK.pieces));
  const pieces = cuts.slice(1).map((to, number) => ({from: cuts[number], to,
    path: line(robot.poses.slice(cuts[number], to + 1)), share: ((run.times[cuts[number]] + run.times[to]) / 2 - begin) / span}));
  return (sheet, row, pose) => {
    sheet.add("track to come", whole, sheet.colour(`own${kind}`));
    for (const {from, to, path, share} of pieces) {
      if (from > row) break;
      const driven = to <= row ? path : line([...robot.poses.slice(from, row + 1), pose]);
      sheet.add("track", driven, hue(sheet.colour, kind, share));
    }
  };
};

// Interpolates the robot's pose between two rows of the recording.
const poseAt = (run, robot, now, row) => {
  const from = robot.poses[row], to = robot.poses[Math.min(row + 1, robot.poses.length - 1)];
  const span = (run.times[row + 1] ?? now) - run.times[row];
  const share = span > 0 ? Math.min(1, Math.max(0, (now - run.times[row]) / span)) : 0;
  return [0, 1, 2].map(axis => from[axis] + share * (to[axis] - from[axis]));
};

const drawRobot = (sheet, run, robot, kind, now, row) => {
  const [x, y, turn] = poseAt(run, robot, now, row), own = sheet.colour(`own${kind}`);
  if (robot.commands && now >= robot.commanded && now < run.times[run.times.length - 1]) { // draw the latest command
    const [linear, angular] = robot.commands[row], way = [];
    for (let px = x, py = y, angle = turn, at = 0; at <= AHEAD; at += 0.05) {
      way.push([px, py]);
      px += 0.05 * linear * Math.cos(angle); py += 0.05 * linear * Math.sin(angle); angle += 0.05 * angular;
    }
    sheet.add("way ahead", line(way));
  }
  const placed = points => loop(points.map(([px, py]) =>
    [x + Math.cos(turn) * px - Math.sin(turn) * py, y + Math.sin(turn) * px + Math.cos(turn) * py]));
  const met = run.collisions.some(([when, , , , who]) => who === robot.name && when <= now + 1e-6 && now - when < MET_SECONDS);
  sheet.add("halo", disc(x, y, sheet.radius("halo")), own);
  sheet.add("body", placed(robot.body), met ? sheet.colour("alarm") : own);
  sheet.add("nose", placed(robot.nose));
  if (run.robots.length > 1) sheet.write(robot.name, [x, y + reach(robot)], [0, -8], "center");
};

const drawCollisions = (sheet, run, now) => {
  for (const name of ["collision halo", "collision"]) {
    const path = new Path2D();
    for (const [when, x, y] of run.collisions) if (when <= now + 1e-6) cross(x, y, sheet.radius(name), path);
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

// Returns a function that draws an instant on a sheet.
const makeScene = run => {
  const kinds = run.robots.map((_, index) => index && 1 + (index - 1) % LOOK.others);
  const addWorld = makeWorld(run), tracks = run.robots.map((robot, index) => makeTrack(run, robot, kinds[index]));
  return (sheet, now, row) => {
    addWorld(sheet);
    run.robots.forEach(robot => drawScan(sheet, robot, now));
    run.world.movers.forEach((radius, index) =>
      sheet.add("mover", disc(run.paths[row][2 * index], run.paths[row][2 * index + 1], radius)));
    run.robots.forEach((robot, index) => tracks[index](sheet, row, poseAt(run, robot, now, row)));
    run.robots.forEach((robot, index) => drawRobot(sheet, run, robot, kinds[index], now, row));
    drawCollisions(sheet, run, now);
    drawMoment(sheet, run, now);
  };
};
