// Plays recorded runs. Each .run-player holds a run as JSON; it gets a canvas, buttons and a time line for each rule.
(() => {
"use strict";
const SPEEDS = [0.25, 0.5, 1, 2, 4];
const AHEAD = 2; // s: how far the path of the newest command is drawn

const inflate = text => {
  const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")));
};
// The text of `pack`: base64, deflated, the bytes of a number apart, changes instead of values.
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
  const run = {...data, times: await column(data.times), paths: await unpack(data.paths)};
  run.world = {...world, room: await unpack(world.room), walls: await unpack(world.walls),
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

// The place of the last time that is not later than `now`; -1 before the first.
const last = (times, now) => {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= now + 1e-6) low = middle + 1; else high = middle;
  }
  return low - 1;
};

const make = (tag, attributes = {}, parent = null) => {
  const node = tag === "svg" || parent instanceof SVGElement
    ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    if (name === "text") node.textContent = value; else node.setAttribute(name, value);
  if (parent) parent.append(node);
  return node;
};

const outline = (pen, points) => { pen.beginPath(); points.forEach(([x, y]) => pen.lineTo(x, y)); pen.closePath(); };
const disc = (pen, x, y, radius) => { pen.beginPath(); pen.arc(x, y, radius, 0, 2 * Math.PI); };

// What stands still: room, furniture, walls, goals, starts. `pen` draws in metres; `dot` is a pixel in metres.
const drawWorld = (pen, run, colour, dot) => {
  const {world} = run;
  pen.fillStyle = colour("floor"); outline(pen, world.room); pen.fill();
  pen.fillStyle = colour("solid");
  for (const loop of world.solid) { outline(pen, loop); pen.fill(); }
  for (const [x, y, radius] of world.goals) {
    pen.fillStyle = pen.strokeStyle = colour("goal"); pen.lineWidth = 1.5 * dot;
    disc(pen, x, y, radius); pen.globalAlpha = 0.14; pen.fill(); pen.globalAlpha = 1; pen.stroke();
  }
  pen.strokeStyle = colour("start"); pen.lineWidth = 1.2 * dot; pen.setLineDash([4 * dot, 3 * dot]);
  const radius = Math.max(...run.robots[0].body.map(([x, y]) => Math.hypot(x, y)));
  for (const [x, y] of world.starts) { disc(pen, x, y, radius); pen.stroke(); }
  pen.setLineDash([]);
  pen.strokeStyle = colour("wall"); pen.lineWidth = 2.5 * dot; pen.lineCap = "round"; pen.beginPath();
  for (const [x1, y1, x2, y2] of world.walls) { pen.moveTo(x1, y1); pen.lineTo(x2, y2); }
  pen.stroke();
  for (const [x, y, size] of world.pillars) { disc(pen, x, y, size); pen.fillStyle = colour("solid"); pen.fill(); pen.stroke(); }
};

const drawScan = (pen, robot, now, colour, dot) => {
  const {scans} = robot, number = scans ? last(scans.times, now) : -1;
  if (number < 0) return;
  const [x, y, turn] = scans.poses[number], [mx, my, mturn] = scans.mount;
  const cx = x + Math.cos(turn) * mx - Math.sin(turn) * my, cy = y + Math.sin(turn) * mx + Math.cos(turn) * my;
  const hits = [];
  pen.beginPath();
  if (!scans.full) pen.moveTo(cx, cy);
  scans.ranges[number].forEach((range, beam) => {
    const angle = turn + mturn + scans.first + beam * scans.turn, length = range < 0 ? scans.reach : range;
    const end = [cx + length * Math.cos(angle), cy + length * Math.sin(angle)];
    pen.lineTo(...end);
    if (range > 0) hits.push(end);
  });
  pen.fillStyle = colour("beam"); pen.globalAlpha = 0.13; pen.fill(); pen.globalAlpha = 1;
  pen.fillStyle = colour("hit");
  for (const [hx, hy] of hits) pen.fillRect(hx - 1.5 * dot, hy - 1.5 * dot, 3 * dot, 3 * dot);
};

// Where the robot is between two rows of the recording.
const poseAt = (run, robot, now, row) => {
  const from = robot.poses[row], to = robot.poses[Math.min(row + 1, robot.poses.length - 1)];
  const span = (run.times[row + 1] ?? now) - run.times[row];
  const share = span > 0 ? Math.min(1, Math.max(0, (now - run.times[row]) / span)) : 0;
  return [0, 1, 2].map(axis => from[axis] + share * (to[axis] - from[axis]));
};

const drawRobot = (pen, run, robot, index, now, row, colour, dot) => {
  const own = index ? ["other0", "other1", "other2", "other3"][(index - 1) % 4] : "robot";
  const [x, y, turn] = poseAt(run, robot, now, row);
  pen.strokeStyle = colour(own); pen.lineWidth = 2.2 * dot; pen.globalAlpha = 0.6; pen.beginPath();
  for (let point = 0; point <= row; point++) pen.lineTo(robot.poses[point][0], robot.poses[point][1]);
  pen.lineTo(x, y); pen.stroke(); pen.globalAlpha = 1;
  if (robot.commands && now >= robot.commanded) { // the path of the next seconds, if the newest command is obeyed
    const [linear, angular] = robot.commands[row];
    pen.strokeStyle = colour("ink"); pen.lineWidth = 1.5 * dot; pen.setLineDash([5 * dot, 4 * dot]); pen.beginPath();
    for (let px = x, py = y, angle = turn, at = 0; at <= AHEAD; at += 0.05) {
      pen.lineTo(px, py);
      px += 0.05 * linear * Math.cos(angle); py += 0.05 * linear * Math.sin(angle); angle += 0.05 * angular;
    }
    pen.stroke(); pen.setLineDash([]);
  }
  pen.save(); pen.translate(x, y); pen.rotate(turn);
  outline(pen, robot.body); pen.fillStyle = colour(own); pen.fill();
  pen.strokeStyle = colour("paper"); pen.lineWidth = 1.2 * dot; pen.stroke();
  outline(pen, robot.nose); pen.fillStyle = colour("paper"); pen.fill();
  pen.restore();
};

const drawCollisions = (pen, run, now, colour, dot) => {
  pen.strokeStyle = colour("alarm"); pen.lineWidth = 2 * dot; pen.beginPath();
  for (const [when, x, y] of run.collisions) {
    if (when > now + 1e-6) continue;
    pen.moveTo(x - 4 * dot, y - 4 * dot); pen.lineTo(x + 4 * dot, y + 4 * dot);
    pen.moveTo(x - 4 * dot, y + 4 * dot); pen.lineTo(x + 4 * dot, y - 4 * dot);
  }
  pen.stroke();
};

const signed = value => (value < 0 ? "\u2212" : "+") + Math.abs(value).toFixed(2);
const velocity = ([linear, angular]) => `${signed(linear)} m/s, ${signed(angular)} rad/s`;

const start = async root => {
  root.classList.add("run-starting");
  const run = await unpackRun(JSON.parse(root.querySelector("script[type='application/json']").textContent));
  const begin = run.times[0], end = run.times[run.times.length - 1];
  const stage = make("div", {class: "run-stage"}, root);
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
  const said = make("p", {class: "run-said"}, stage);
  const words = make("span", {}, said), hit = make("span", {class: "run-hit"}, said);
  const margins = run.margins.map(margin => makeMargin(margin));
  const log = run.said.length ? makeLog() : () => {};
  const help = make("details", {}, stage);
  make("summary", {text: "Keys"}, help);
  make("span", {text: "Space plays and pauses. The arrow keys move by 0.1 s, with Shift by 1 s. Home and End go to "
    + "the ends. B goes to the instant at which a rule broke. L goes to the next line of the log, with Shift to the one before. The dashed line is the way of the next 2 s, if the "
    + "robot obeys the newest command."}, help);
  let now = begin, playing = false, before = null, still = null, dot = 1;

  function makeMargin(margin) {
    const box = make("div", {class: "run-margin"}, stage), row = make("div", {class: "run-row"}, box);
    const name = make("span", {}, row);
    if (margin.broken !== null)
      make("button", {type: "button", class: "run-jump", text: `broken at t = ${margin.broken.toFixed(1)} s`}, row)
        .addEventListener("click", () => show(margin.broken));
    const low = Math.min(0, ...margin.values), high = Math.max(0, ...margin.values), height = high - low || 1;
    const across = time => 1000 * (time - begin) / (end - begin || 1), up = value => 4 + 56 * (high - value) / height;
    const svg = make("svg", {viewBox: "0 0 1000 64", preserveAspectRatio: "none", role: "img",
      "aria-label": `Margin of the rule: ${margin.rule}`}, box);
    make("rect", {class: "run-below", x: 0, width: 1000, y: up(0), height: 64 - up(0)}, svg);
    make("path", {class: "run-zero", d: `M0 ${up(0)}H1000`}, svg);
    const points = Array.from(margin.times, (time, place) => `${across(time).toFixed(2)} ${up(margin.values[place]).toFixed(2)}`);
    make("path", {class: "run-line", d: "M" + points.join("L")}, svg);
    if (margin.broken !== null) make("path", {class: "run-broken", d: `M${across(margin.broken)} 0V64`}, svg);
    const cursor = make("path", {class: "run-cursor", d: "M0 0V64"}, svg);
    const seek = event => show(begin + (end - begin) * (event.clientX - svg.getBoundingClientRect().left) / svg.clientWidth);
    svg.addEventListener("pointerdown", event => { svg.setPointerCapture(event.pointerId); seek(event); });
    svg.addEventListener("pointermove", event => { if (event.buttons) seek(event); });
    return () => {
      cursor.setAttribute("transform", `translate(${across(now)} 0)`);
      const place = last(margin.times, now);
      name.textContent = margin.rule + (place < 0 ? "" : `: margin ${signed(margin.values[place])}`);
    };
  }

  // What the programs wrote; a text is set as text, so nothing in it is markup.
  function makeLog() {
    make("p", {class: "run-heading", text: "What the programs wrote"}, stage);
    const list = make("ol", {class: "run-log", tabindex: "0", "aria-label": "What the programs wrote"}, stage);
    const lines = run.said.map(([time, text]) => {
      const line = make("li", {}, list);
      make("span", {class: "run-when", text: `${time.toFixed(1)} s`}, line);
      make("bdi", {text}, line);
      line.addEventListener("click", () => show(time));
      return line;
    });
    const times = run.said.map(([time]) => time);
    let from = 0, until = 0;
    return () => {
      const place = last(times, now), first = place < 0 ? 0 : last(times, times[place] - 0.001) + 1;
      if (first === from && place + 1 === until) return;
      lines.slice(from, until).forEach(line => line.removeAttribute("aria-current"));
      [from, until] = [first, place + 1];
      lines.slice(from, until).forEach(line => line.setAttribute("aria-current", "time"));
      if (until) list.scrollTop = lines[place].offsetTop + lines[place].offsetHeight + 5 - list.clientHeight;
    };
  }
  const nextLine = back => {
    const times = run.said.map(([time]) => time).filter(time => back ? time < now - 1e-3 : time > now + 1e-3);
    if (times.length) show(back ? times[times.length - 1] : times[0]);
  };

  const styles = getComputedStyle(root);
  const colour = name => styles.getPropertyValue(`--run-${name}`);
  const pen = canvas.getContext("2d");
  const setScale = target => {
    const [left, , right, high] = run.world.bounds, scale = canvas.width / (right - left);
    target.setTransform(scale, 0, 0, -scale, -left * scale, high * scale);
    return devicePixelRatio / scale;
  };
  const resize = () => {
    const [left, low, right, high] = run.world.bounds, shape = (high - low) / (right - left);
    const width = Math.min(stage.clientWidth, 0.7 * window.innerHeight / shape);
    if (!width) return;
    canvas.style.width = `${width}px`;
    canvas.width = Math.round(width * devicePixelRatio);
    canvas.height = Math.round(width * shape * devicePixelRatio);
    still = make("canvas", {width: canvas.width, height: canvas.height});
    const target = still.getContext("2d");
    dot = setScale(target);
    drawWorld(target, run, colour, dot);
    draw();
  };
  const draw = () => {
    const row = Math.max(0, last(run.times, now)), robot = run.robots[0];
    clock.textContent = `${now.toFixed(2)} s`;
    slider.value = now;
    const ordered = robot.commands && now >= robot.commanded ? ` \u00b7 commanded ${velocity(robot.commands[row])}` : "";
    const gap = robot.gaps[row] < 999 ? ` \u00b7 gap ${Math.max(0, robot.gaps[row]).toFixed(2)} m` : "";
    words.textContent = `moves ${velocity(robot.velocities[row])}${ordered}${gap}`;
    const met = run.collisions.filter(([when]) => when <= now + 1e-6 && now - when < 1);
    hit.textContent = met.length ? ` \u00b7 ${met[met.length - 1][3]}` : "";
    if (link) link.href = `#${new URLSearchParams({...(root.id && {run: root.id}), t: now.toFixed(2)})}`;
    margins.forEach(update => update());
    log();
    if (!still) return;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(still, 0, 0);
    setScale(pen);
    run.robots.forEach(each => drawScan(pen, each, now, colour, dot));
    run.world.movers.forEach((radius, index) => {
      pen.fillStyle = colour("mover"); disc(pen, run.paths[row][2 * index], run.paths[row][2 * index + 1], radius); pen.fill();
    });
    run.robots.forEach((each, index) => drawRobot(pen, run, each, index, now, row, colour, dot));
    drawCollisions(pen, run, now, colour, dot);
  };

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
  const show = time => { setPlaying(false); now = Math.min(end, Math.max(begin, time)); draw(); };
  const broken = run.margins.map(margin => margin.broken).filter(time => time !== null);
  const keys = {
    " ": () => setPlaying(!playing), Home: () => show(begin), End: () => show(end),
    ArrowLeft: event => show(now - (event.shiftKey ? 1 : 0.1)), ArrowRight: event => show(now + (event.shiftKey ? 1 : 0.1)),
    l: () => nextLine(false), L: () => nextLine(true),
    b: () => { if (broken.length) show(Math.min(...broken)); },
  };
  root.addEventListener("keydown", event => {
    const press = event.target.closest("button, a, summary") && event.key === " ";
    if (!keys[event.key] || press || event.target === speed || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    keys[event.key](event);
  });
  button.addEventListener("click", () => setPlaying(!playing));
  form.addEventListener("submit", event => event.preventDefault());
  slider.addEventListener("input", () => show(Number(slider.value)));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", resize);
  root.classList.add("run-ready");
  new ResizeObserver(resize).observe(stage);
  resize();

  const follow = () => {
    const wanted = new URLSearchParams(location.hash.slice(1)), time = parseFloat(wanted.get("t"));
    const chosen = document.querySelector(".run-player[data-first]") || document.querySelector(".run-player");
    if (!Number.isFinite(time) || (wanted.has("run") ? wanted.get("run") !== root.id : root !== chosen)) return;
    for (let box = root.closest("details"); box; box = box.parentElement.closest("details")) box.open = true;
    show(time);
    root.scrollIntoView();
  };
  if (link) { window.addEventListener("hashchange", follow); follow(); }
  if (root.dataset.play && !matchMedia("(prefers-reduced-motion: reduce)").matches) setPlaying(true);
};

for (const root of document.querySelectorAll(".run-player:not(.run-starting)")) start(root);
})();
