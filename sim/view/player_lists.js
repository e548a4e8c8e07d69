// The lists below the canvas: a time line for each rule, the output of the programs, and the robots' data.
const make = (tag, attributes = {}, parent = null) => {
  const node = tag === "svg" || parent instanceof SVGElement
    ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    if (name === "text") node.textContent = value; else node.setAttribute(name, value);
  if (parent) parent.append(node);
  return node;
};
const signed = value => (value < 0 ? "\u2212" : "+") + Math.abs(value).toFixed(2);

// Returns a function that shows an instant. `show` is called with an instant that the user selects.
const makeMargin = (stage, margin, begin, end, show) => {
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
  return now => {
    cursor.setAttribute("transform", `translate(${across(now)} 0)`);
    const place = last(margin.times, now);
    name.textContent = margin.rule + (place < 0 ? "" : `: margin ${signed(margin.values[place])}`);
  };
};

// Returns a function that shows an instant. Lines are set as text, so they cannot contain markup.
const makeLog = (stage, said, show) => {
  make("p", {class: "run-heading", text: "What the programs wrote"}, stage);
  const list = make("ol", {class: "run-log", tabindex: "0", "aria-label": "What the programs wrote"}, stage);
  const lines = said.map(([time, text]) => {
    const item = make("li", {}, list);
    make("span", {class: "run-when", text: `${time.toFixed(1)} s`}, item);
    make("bdi", {text}, item);
    item.addEventListener("click", () => show(time));
    return item;
  });
  const times = said.map(([time]) => time);
  let from = 0, until = 0;
  return now => {
    const place = last(times, now), first = place < 0 ? 0 : last(times, times[place] - 0.001) + 1;
    if (first === from && place + 1 === until) return;
    lines.slice(from, until).forEach(item => item.removeAttribute("aria-current"));
    [from, until] = [first, place + 1];
    lines.slice(from, until).forEach(item => item.setAttribute("aria-current", "time"));
    if (until) list.scrollTop = lines[place].offsetTop + lines[place].offsetHeight + 5 - list.clientHeight;
  };
};

// Shows each robot's data at an instant: its velocity, its command, and the distance of the nearest obstacle.
const velocityText = ([linear, angular]) => `${signed(linear)} m/s, ${signed(angular)} rad/s`;
const makeReadout = (stage, run) => {
  const box = make("div", {class: "run-said"}, stage);
  const rows = run.robots.map(robot => {
    const row = make("p", {}, box);
    if (run.robots.length > 1) make("strong", {text: `${robot.name}: `}, row);
    return [make("span", {}, row), make("span", {class: "run-hit"}, row)];
  });
  return ({robots}) => robots.forEach(({velocity, command, gap, met}, index) => {
    const [words, hit] = rows[index];
    const ordered = command ? ` \u00b7 commanded ${velocityText(command)}` : "";
    const distance = gap < MAX_GAP ? ` \u00b7 gap ${Math.max(0, gap).toFixed(2)} m` : "";
    words.textContent = `moves ${velocityText(velocity)}${ordered}${distance}`;
    hit.textContent = met ? ` \u00b7 ${met}` : "";
  });
};
