// Unpacks a run that `encode` packed. A run from an earlier version lacks some fields.
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

const unpackRun = async data => {
  const world = data.world;
  const run = {title: world.name, summary: "", moment: null, ...data, times: await column(data.times),
    paths: await unpack(data.paths)};
  run.world = {inside: world.bounds, routes: [], ...world, room: await unpack(world.room), walls: await unpack(world.walls),
    pillars: await unpack(world.pillars), solid: await Promise.all(world.solid.map(unpack))};
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
