// Unpacks a run that `encode` packed, and returns its instants. A run from an earlier version lacks some fields.
const inflate = text => {
  const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")));
};
// Decodes the text of `pack`: base64, deflated, the bytes of a number in separate planes, differences of rows.
const unpack = async packed => {
  if (!packed) return null;
  const planes = new Uint8Array(await inflate(packed.data).arrayBuffer());
  const count = planes.length / 4, columns = packed.columns, sums = new Array(columns).fill(0), rows = [];
  for (let cell = 0; cell < count; cell++) {
    const coded = planes[cell] + planes[count + cell] * 256 + planes[2 * count + cell] * 65536
      + planes[3 * count + cell] * 16777216;
    const column = cell % columns;
    sums[column] += coded % 2 ? -(coded + 1) / 2 : coded / 2;
    if (column === 0) rows.push(new Float64Array(columns));
    rows[rows.length - 1][column] = sums[column] * packed.step;
  }
  return rows;
};
const column = async packed => Float64Array.from(await unpack(packed), row => row[0]);

const unpackSaid = async said => {
  if (!said) return [];
  const texts = await inflate(said.texts).json();
  return Array.from(await column(said.times), (time, place) => [time, texts[place]]);
};

const unpackWorld = async world => ({inside: world.bounds, routes: [], ...world, room: await unpack(world.room),
  walls: await unpack(world.walls), pillars: await unpack(world.pillars), solid: await Promise.all(world.solid.map(unpack))});

const unpackRun = async data => {
  const world = data.world;
  const run = {title: world.name, summary: "", moment: null, ...data, times: await column(data.times),
    paths: await unpack(data.paths)};
  run.world = await unpackWorld(world);
  run.robots = await Promise.all(data.robots.map(async robot => ({...robot, poses: await unpack(robot.poses),
    velocities: await unpack(robot.velocities), gaps: await column(robot.gaps), commands: await unpack(robot.commands),
    commanded: robot.commands ? robot.commands.first : Infinity,
    scans: robot.scans && {...robot.scans, times: await column(robot.scans.times),
      poses: await unpack(robot.scans.poses), ranges: await unpack(robot.scans.ranges)}})));
  run.said = await unpackSaid(data.said);
  run.margins = await Promise.all(data.margins.map(async margin =>
    ({...margin, times: await column(margin.times), values: await column(margin.values)})));
  return run;
};

// Returns the index of the last time that is not later than `now`, or -1 before the first.
const last = (times, now) => {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= now + 1e-6) low = middle + 1; else high = middle;
  }
  return low - 1;
};

// Interpolates a robot's pose between two rows of the run.
const poseAt = (run, robot, now, row) => {
  const from = robot.poses[row], to = robot.poses[Math.min(row + 1, robot.poses.length - 1)];
  const span = (run.times[row + 1] ?? now) - run.times[row];
  const share = span > 0 ? Math.min(1, Math.max(0, (now - run.times[row]) / span)) : 0;
  return [0, 1, 2].map(axis => from[axis] + share * (to[axis] - from[axis]));
};

const scanAt = ({scans}, now) => {
  const number = scans ? last(scans.times, now) : -1;
  return number < 0 ? null : {pose: scans.poses[number], ranges: scans.ranges[number]};
};

// Returns the instant `now` of a run, for the drawing and the readout.
const instantOf = (run, now) => {
  const row = Math.max(0, last(run.times, now)), isObeying = now < run.times[run.times.length - 1];
  return {time: now, row, collisions: run.collisions,
    movers: run.world.movers.map((_, index) => [run.paths[row][2 * index], run.paths[row][2 * index + 1]]),
    robots: run.robots.map(robot => ({pose: poseAt(run, robot, now, row), velocity: robot.velocities[row],
      command: robot.commands && now >= robot.commanded ? robot.commands[row] : null, isObeying, gap: robot.gaps[row],
      met: metAt(run.collisions, robot.name, now), scan: scanAt(robot, now)}))};
};

// Returns a function that draws a robot's track in pieces. The driven part is thick, the future part thin.
const makeTracks = run => {
  const begin = run.times[0], rows = run.times.length - 1, span = run.times[rows] - begin || 1;
  const tracks = run.robots.map(({poses}) => ({whole: line(poses), parts: pieces(rows).map(([from, to]) =>
    ({from, to, path: line(poses.slice(from, to + 1)), share: ((run.times[from] + run.times[to]) / 2 - begin) / span}))}));
  return (sheet, index, kind, {row, robots}) => {
    const {whole, parts} = tracks[index];
    sheet.add("track to come", whole, sheet.colour(`own${kind}`));
    for (const {from, to, path, share} of parts) {
      if (from > row) break;
      const driven = to <= row ? path : line([...run.robots[index].poses.slice(from, row + 1), robots[index].pose]);
      sheet.add("track", driven, hue(sheet.colour, kind, share));
    }
  };
};
