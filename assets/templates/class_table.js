// Sorts and filters the table of a class. The form fields are the only state. The browser restores them when the user
// returns from a student's page. Without this script, the table stays unsorted and unfiltered.
"use strict";
const form = document.querySelector("form.filter");
const { words, show, order } = form.elements;
const body = document.querySelector("table.class tbody");
const rows = [...body.rows];
const headers = [...document.querySelectorAll("table.class thead th")];
const { compare } = new Intl.Collator(undefined, { numeric: true });

function plain(text) {
  return text.normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase();
}

function value(row, column) {
  return row.cells[column].dataset.value ?? row.cells[column].textContent.trim();
}

function update() {
  const terms = plain(words.value).split(/\s+/);
  const [column, direction] = order.value.split(" ").map(Number);
  let count = 0;
  for (const row of rows) {
    const text = plain(row.textContent);
    const matches = !show.value || row.dataset.choices.split(" ").includes(show.value);
    row.hidden = !(matches && terms.every(term => text.includes(term)));
    count += !row.hidden;
  }
  body.append(...[...rows].sort((one, other) => direction * compare(value(one, column), value(other, column))));
  headers.forEach(header => header.removeAttribute("aria-sort"));
  headers[column].setAttribute("aria-sort", direction > 0 ? "ascending" : "descending");
  form.querySelector("output").textContent = `${count} of ${rows.length}`;
}

for (const column of new Set([...order.options].map(option => parseInt(option.value)))) {
  const header = headers[column], button = document.createElement("button");
  button.type = "button";
  button.append(...header.childNodes);
  header.append(button);
  button.addEventListener("click", () => {
    order.value = `${column} ${header.getAttribute("aria-sort") === "ascending" ? -1 : 1}`;
    update();
  });
}
form.addEventListener("input", update);
form.addEventListener("submit", event => event.preventDefault());
addEventListener("pageshow", update);  // after the browser has restored the fields
form.hidden = false;
