// The Collision view: 21 values, answered while one types.
import { amount, ask, asked, attempt, drawInto, element, fill, newest, page, save, settled, showUnits, shown, stop, tabs, tell, unitWord, watched, what } from "./ask.js";

const form = () => page("collision-form");
const inputs = () => [...form().querySelectorAll("fieldset input")];
let extra = {}; // lengths and widths from a file: drawn, and saved again
const values = () => ({ ...extra, ...Object.fromEntries(inputs().map((input) => [input.name, input.value])) });
const question = () => ({ values: values(), title: page("collision-title").value, units: page("collision-units").value });
const trouble = (error) => tell(page("collision-trouble"), error);

/** What is wrong with each value, at its field. */
function showProblems(problems, ranges) {
  tell(page("collision-units-problem"), problems.units && { message: problems.units });
  for (const input of inputs()) {
    const problem = problems[input.name];
    tell(page(`collision-${input.name}-problem`), problem && { message: problem });
    if (problem) input.setAttribute("aria-invalid", "true");
    else input.removeAttribute("aria-invalid");
    input.classList.toggle("range", ranges.includes(input.name));
  }
}

/** What stands between the form and an answer. */
function waitingFor(answer) {
  const wrong = Object.keys(answer.problems);
  const parts = [];
  if (answer.missing.length >= inputs().length - 1) {
    parts.push("Fill in the values, or begin with a published run. The answer appears here while you type.");
  } else if (answer.missing.length) {
    parts.push(`Still to fill in: ${answer.missing.join(" ")}.`);
  }
  if (wrong.length) parts.push(`To be corrected: ${wrong.join(" ")}.`);
  if (parts.length && !page("collision-answer").hidden) parts.push("Below is the answer to the values before.");
  return parts.join(" ");
}

/** What is asked of a collision, a column for each vehicle; what belongs to both spans them. */
function showFirst(rows) {
  const table = page("collision-first");
  const cell = ({ name, text, value }, unit) => amount(text, value, name, unit);
  fill(table, "Answer", ["what", "A", "B", "unit"], rows.map(({ words, unit, values: [one, other] }) =>
    [words, cell(one, unit), other ? cell(other, unit) : "", element("small", {}, unitWord(unit))]));
  for (const row of table.tBodies[0].rows) {
    if (row.cells[2].textContent) continue;
    row.cells[2].remove();
    row.cells[1].colSpan = 2;
  }
}

/** The Apple's screen: 24 rows of 40 characters, inverse and flashing ones as such. */
function showScreen(rows) {
  page("collision-apple").replaceChildren(...rows.map((runs) => element("span", { className: "row" },
    ...runs.map(([kind, text]) => (kind === "normal" ? text : element("span", { className: kind }, text))), "\n")));
}

function showAnswer(answer) {
  page("collision-answer").hidden = false;
  page("collision-signs").hidden = true;
  page("collision-more-signs").hidden = false;
  showFirst(answer.answer);
  page("collision-screen").textContent = answer.page;
  showScreen(answer.screen);
  for (const note of document.querySelectorAll("#collision .nominal")) note.hidden = !answer.ranges.length;
  page("collision-warnings").querySelector("ul")
    .replaceChildren(...answer.warnings.map((text) => element("li", {}, text)));
  page("collision-warnings").hidden = !answer.warnings.length;
  const shownToo = answer.results.some((row) => row.shown);
  const whole = (row, text) => amount(text, row.value, row.name, row.label);
  fill(page("collision-results"), "All results", ["name", "what", "printed", "exact", ...(shownToo ? ["that is"] : [])],
    answer.results.map((row) => [row.name, what(row), row.printed,
      row.shown ? row.exact : whole(row, row.exact), ...(shownToo ? [row.shown && whole(row, row.shown)] : [])]));
}

let latest = null;
const announce = settled(() => {
  const [{ words, unit, values: [a, b] }] = latest.answer;
  const said = `${words}: A ${a.text}, B ${b.text} ${unit}. `;
  page("collision-said").textContent = `${said}Warnings: ${latest.warnings.length}.`;
}, 1200);

const draw = newest(async () => {
  const picture = page("collision-figure");
  picture.parentElement.classList.toggle("stale", !await drawInto(picture, question()));
});

const SHARES = ["0.05", "0.95"]; // of the quantiles, those there is room for

function boundsRow([name, bound]) {
  const width = Math.abs((bound.upper ?? 0) - (bound.lower ?? 0));
  const drives = Object.entries(bound.drives)
    .map(([input, drive]) => [input, (drive.highest ?? 0) - (drive.lowest ?? 0)])
    .filter(([, swing]) => swing > 1e-9 * width)
    .sort((one, other) => other[1] - one[1])
    .slice(0, 2)
    .map(([input, swing]) => `${input} ${shown(swing, 3)}`);
  const cell = (part, value, digits) => amount(shown(value, digits), value, `${name} ${part}`, bound.unit);
  return [
    name, what(bound), ...["lower", "nominal", "upper"].map((part) => cell(part, bound[part], 4)),
    ...SHARES.map((share) => cell(share, bound.quantiles[share], 4)), drives.join(", "),
  ];
}

function showBounds(found) {
  const shares = SHARES.map((share) => `${shown(100 * share, 3)} %`);
  fill(page("collision-bounds-table"), "Bounds",
    ["name", "what", "lower", "nominal", "upper", ...shares, "driven by"],
    Object.entries(found.outputs).map(boundsRow));
  const warned = Object.entries(found.warnings).map(([name, share]) => `${shown(100 * share, 3)} % ${name}`);
  page("collision-bounds-note").textContent =
    `Lower and upper: extremes over all ranges, attained, sought in ${found.evaluations.toLocaleString("en")} scenes. `
    + `Quantiles: ${found.samples.toLocaleString("en")} draws, seed ${found.seed}.`
    + (warned.length ? ` Draws with a warning: ${warned.join(", ")}.` : "");
}

const explore = settled(async () => {
  const note = page("collision-bounds-note");
  const sent = JSON.stringify(question());
  note.textContent = "Computing …";
  page("collision-bounds-stop").hidden = false;
  page("collision-bounds-table").classList.add("stale");
  let found = null;
  let problem = "Stopped.";
  try {
    found = await asked("bounds", JSON.parse(sent));
  } catch (error) {
    problem = error.message;
  }
  if (sent !== JSON.stringify(question())) return; // a newer one is on its way
  page("collision-bounds-stop").hidden = true;
  page("collision-bounds-table").classList.remove("stale");
  if (found) {
    showBounds(found);
  } else {
    note.textContent = problem;
    page("collision-bounds-table").replaceChildren();
  }
}, 350);

let exploring = false;
const answer = newest(async () => {
  let told;
  try {
    told = await asked("collision", question());
  } catch (error) {
    trouble(error);
    return;
  }
  trouble(null);
  showProblems(told.problems, told.ranges);
  showUnits(form(), told.units);
  page("collision-base").textContent = told.units.base;
  const ranged = told.ranges.length > 0 && Boolean(told.oracle);
  if (exploring && !ranged) {
    explore.forget();
    stop("bounds");
  }
  exploring = ranged;
  const waiting = waitingFor(told);
  page("collision-waiting").textContent = waiting;
  page("collision-answer").classList.toggle("stale", Boolean(waiting));
  if (!told.oracle) return;
  page("collision-bounds").hidden = !ranged;
  latest = told;
  showAnswer(told);
  announce();
  draw();
  if (ranged) explore();
});

function load(scene) {
  for (const input of inputs()) input.value = scene.values[input.name] ?? "";
  extra = scene.extra ?? {};
  tell(page("collision-remarks"), scene.remarks?.length && { message: scene.remarks.join(" ") });
  page("collision-title").value = scene.title;
  page("collision-units").value = scene.units ?? "";
  answer();
}

const doing = (work) => attempt(work, trouble);

/** Start the view. */
export function collision() {
  form().addEventListener("input", (event) => {
    if (event.target.name !== "title") answer();
  });
  form().addEventListener("submit", (event) => event.preventDefault());
  page("collision-sample").addEventListener("change", (event) => {
    const number = event.target.value;
    event.target.value = "";
    if (number) doing(async () => load(await asked(`sample/${number}`)));
  });
  page("collision-units").addEventListener("change", answer);
  page("collision-open").addEventListener("click", () => page("collision-file").click());
  page("collision-file").addEventListener("change", (event) => {
    const [file] = event.target.files;
    if (file) {
      doing(async () => {
        load(await asked("scene", file, { name: file.name }));
        page("collision-file").value = "";
      });
    }
  });
  page("collision-save").addEventListener("click", () => doing(async () =>
    save(await ask("scene-file", question()))));
  page("collision-report").addEventListener("click", () => doing(async () => {
    const busy = page("collision-busy");
    const response = await watched(busy, "Writing the report", "bounds", ask("case-report/collision", question()));
    if (response) await save(response);
  }));
  tabs(document.querySelector("#collision .tabs"));
  page("collision-print").addEventListener("click", () => print());
  addEventListener("desk-scene", (event) => load(event.detail));
  page("collision-bounds-stop").addEventListener("click", () => stop("bounds"));
  answer();
}
