// The Paper view: papers, their verdicts, and the text of one of them to be edited beside its scan.
import { ask, asked, element, fill, page, save, settled, stop, tell, watched } from "./ask.js";
import { draw as drawMarks, offsetsIn, shifted } from "./marks.js";

/** One paper: its file, its text as it stands on the page, its scan, and what was answered. */
class Paper {
  constructor(name, file, text = null) {
    this.name = name;
    this.file = file; // as opened; null when it was pasted
    this.text = text; // null until the desk has read the file
    this.edited = file === null;
    this.answer = null;
    this.marks = [];
    this.trouble = "";
    this.scan = null;
    this.row = null; // its place in the list
  }

  /** Whether a picture is judged: its text proposes, and the picture decides. */
  get pictured() {
    return this.file !== null && isPicture(this.file);
  }

  /** What is judged: the file as opened, or the text that has become of it. */
  get body() {
    return this.edited && !this.pictured ? new Blob([this.text ?? ""]) : this.file;
  }

  get empty() {
    return this.edited && !this.text?.trim();
  }

  /** For each printout its words, and its object as `verification`. */
  get printouts() {
    const objects = this.answer ? verdictsOf(this.answer) : [];
    return objects.map((verification, at) => ({ ...this.answer.printouts[at], verification }));
  }
}

const papers = [];
let current = null;
let pasted = 0;
const PICTURE = /\.(png|jpe?g|gif|webp|bmp|pdf)$/i;
const isPicture = (file) => file.type.startsWith("image/") || file.type === "application/pdf" || PICTURE.test(file.name);
const stem = (name) => name.replace(/\.[^.]*$/, "").toLowerCase();

// --- judging ------------------------------------------------------------------------------------

function taken(paper, answer, sent) {
  if (!answer) return;
  if (paper.edited && sent !== paper.text) return; // a newer text is on its way
  paper.answer = answer;
  paper.trouble = answer.problem ?? "";
  const open = paper.edited && verdictsOf(answer).every((one) => one.verdict === "incomplete");
  if (answer.text !== null && (paper.pictured ? !open : !paper.edited)) paper.text = answer.text;
  paper.marks = answer.text === paper.text || !paper.pictured ? marksOf(answer) : [];
  showList();
  if (paper === current) showPaper(paper.pictured || !paper.edited);
}

async function judge(paper, bench) {
  if (paper.empty) {
    Object.assign(paper, { answer: null, marks: [], trouble: "" });
    showList();
    if (paper === current) showPaper(false);
    return;
  }
  const sent = paper.text;
  try {
    const seed = paper.edited && paper.pictured ? paper.text : "";
    const answer = asked("judge", paper.body, { name: paper.name, bench, seed });
    taken(paper, await watched(page("paper-busy"), `Reading ${paper.name}`, bench, answer), sent);
  } catch (error) {
    paper.trouble = error.message;
    showList();
    if (paper === current) showPaper(false);
  }
}

let judging = false;
async function judgeAll() {
  if (judging) return;
  judging = true;
  try {
    for (;;) {
      const next = papers.find((paper) => !paper.answer && !paper.trouble && !paper.empty);
      if (!next) return;
      await judge(next, "paper");
      if (!next.answer && !next.trouble) next.trouble = "Not judged: stopped.";
    }
  } finally {
    judging = false;
    showList();
  }
}

const judgeEdited = settled(() => current && judge(current, "edit"), 200);

/** The objects of an answer that hold a verdict. */
const verdictsOf = (answer) => answer.objects.filter((one) => one.verdict);

/** The marks of an answer: places in the text with what stands there. */
function marksOf(answer) {
  const marks = [];
  const place = offsetsIn(answer.text ?? "");
  const mark = ({ start, stop }, kind, more) => marks.push({ start: place(start), stop: place(stop), kind, ...more });
  for (const verdict of verdictsOf(answer)) {
    for (const check of [...verdict.fields, ...verdict.replies]) {
      if (check.start === null) continue;
      const doubts = check.doubts.map((one) => ({ ...one, start: place(one.start) }));
      mark(check, check.status.replace(" ", "-"), { check, doubts });
    }
    for (const piece of verdict.left_over) mark(piece, "left-over", {});
  }
  return marks.sort((one, other) => one.start - other.start);
}

// --- the list -----------------------------------------------------------------------------------

function chip(title, kind) {
  return element("span", { className: `chip ${kind}` }, title);
}

function chips(paper) {
  if (paper.trouble) return [chip("NOT JUDGED", "unreadable")];
  if (paper.empty) return [chip("empty", "none")];
  if (!paper.answer) return [chip("…", "none")];
  return paper.printouts.map(({ title, verification }) => chip(title, verification.verdict));
}

/** A paper's row: made once, so that the focus stays on it. */
function rowOf(paper) {
  if (!paper.row) {
    const button = element("button", { type: "button", className: "paper-name" });
    button.addEventListener("click", () => choose(paper));
    paper.row = element("li", {}, button);
  }
  const button = paper.row.firstElementChild;
  button.replaceChildren(element("span", { className: "file" }, paper.name), " ", ...chips(paper));
  if (paper === current) button.setAttribute("aria-current", "true");
  else button.removeAttribute("aria-current");
  return paper.row;
}

function showList() {
  const list = page("paper-list");
  const rows = papers.map(rowOf);
  for (const row of [...list.children]) if (!rows.includes(row)) row.remove();
  for (const row of rows) if (row.parentElement !== list) list.append(row);
  const counts = new Map();
  for (const paper of papers) {
    for (const one of chips(paper)) counts.set(one.textContent, (counts.get(one.textContent) ?? 0) + 1);
  }
  counts.delete("empty");
  const waiting = counts.get("…");
  counts.delete("…");
  const parts = [...counts].map(([title, count]) => `${count} ${title}`);
  if (waiting) parts.push(`${waiting} still to be read`);
  page("paper-summary").textContent = parts.join(", ");
  const some = papers.some((paper) => !paper.empty);
  page("paper-report").disabled = !some;
  page("paper-save").disabled = !current?.text;
  page("paper-remove").disabled = !current || (papers.length === 1 && current.empty);
  page("paper-add-scan").disabled = !current;
}

function choose(paper) {
  current = paper;
  showList();
  showPaper(true);
}

// --- one paper ----------------------------------------------------------------------------------

function verdictOf(paper) {
  if (paper.trouble) return [["unreadable", "NOT JUDGED", paper.trouble, []]];
  return paper.printouts.map((one) => [one.verification.verdict, one.title, one.says, one.summary]);
}

function showVerdict() {
  const place = page("paper-verdict");
  const verdicts = verdictOf(current);
  const several = verdicts.length > 1;
  place.className = "verdicts";
  place.hidden = !verdicts.length;
  // what has not changed is not read out again
  const said = JSON.stringify(verdicts);
  if (place.dataset.said === said) return;
  place.dataset.said = said;
  place.replaceChildren(...verdicts.map(([kind, title, says, summary], at) =>
    element("div", { className: `verdict ${kind}` },
      element("p", { className: "word" }, several ? `Printout ${at + 1}: ${title}` : title),
      element("p", {}, says),
      ...summary.map((line) => element("p", { className: "counts" }, line)))));
}

/** Show the current paper; `afresh` puts its text into the editor. */
function showPaper(afresh) {
  const text = page("paper-text");
  if (afresh && text.value !== (current.text ?? "")) text.value = current.text ?? "";
  text.readOnly = current.text === null && !current.trouble;
  page("paper-revert").hidden = !(current.edited && current.file);
  showVerdict();
  showMarks();
  showPrintouts();
  showScan();
}

function showMarks() {
  drawMarks(page("paper-marks"), page("paper-lines"), page("paper-text").value, current.marks);
  page("paper-legend").hidden = !current.marks.length;
  showHere();
}

/** Under the editor: what the number at the cursor is. */
function showHere() {
  const at = page("paper-text").selectionStart;
  const mark = current?.marks.find((one) => one.start <= at && at <= one.stop);
  const check = mark?.check;
  const line = page("paper-text").value.slice(0, at).split("\n");
  const where = `line ${line.length}, column ${line.at(-1).length + 1}`;
  page("paper-here").textContent = check
    ? `${where} · ${check.name}: read ${check.printed ?? "nothing"}, recomputed ${check.recomputed ?? "nothing"} · ${check.status}`
    : where;
}

/** Put the cursor on a place in the text, and show it. */
function goTo(start, stop) {
  const text = page("paper-text");
  text.focus({ preventScroll: true });
  text.setSelectionRange(start, stop);
  showHere();
  const editor = page("paper-editor");
  const before = text.value.slice(0, start).split("\n");
  const style = getComputedStyle(text);
  const top = (before.length - 1) * parseFloat(style.lineHeight);
  editor.scrollTop = Math.max(0, top - editor.clientHeight / 2);
  editor.scrollLeft = 0;
  page("paper-editor").scrollIntoView({ block: "nearest" });
}

const STATUS_MARK = { read: "✓", doubtful: "?", contradicted: "✗", "not read": "–", "not compared": "–" };

function numbersTable({ verification }) {
  const table = element("table", { className: "checks" });
  const replies = verification.replies.filter((one) => one.same !== true);
  const checks = [...verification.fields, ...replies];
  fill(table, "The page's numbers", ["name", "as read", "printed", "recomputed", "exact", "printed − exact"], checks.map((check) => {
    const name = check.start === null || check.start === undefined ? check.name
      : element("button", { type: "button", className: "to-place", title: "Show it in the text" }, check.name);
    if (name.addEventListener) {
      name.addEventListener("click", () => {
        const mark = current.marks.find((one) => one.check === check);
        if (mark) goTo(mark.start, mark.stop);
      });
    }
    const status = element("span", { className: `status ${check.status.replace(" ", "-")}` },
      element("span", { "aria-hidden": "true" }, `${STATUS_MARK[check.status]} `), check.status);
    const named = replies.includes(check) ? element("span", {}, name, " typed") : name;
    return [named, status, check.printed ?? "–", check.recomputed ?? "–", check.exact ?? "", check.difference ?? ""];
  }), (place) => checks[place].status.replace(" ", "-"));
  return table;
}

/** Where "line 3, column 14" is in the text that was judged; null for a text that names no place. */
function placeIn(sentence) {
  const named = /line (\d+), column (\d+)/.exec(sentence);
  if (!named || !current.answer?.text) return null;
  const lines = current.answer.text.split("\n");
  const before = lines.slice(0, Number(named[1]) - 1);
  const line = lines[before.length] ?? "";
  const start = before.reduce((sum, one) => sum + one.length + 1, 0) + offsetsIn(line)(Number(named[2]) - 1);
  const mark = current.marks.find((one) => one.start <= start && start < one.stop);
  return mark ? [mark.start, mark.stop] : [start, start + 1];
}

function partList({ heading, items }) {
  const list = element("ul", {}, ...items.map((sentence) => {
    const place = placeIn(sentence);
    if (!place) return element("li", {}, sentence);
    const button = element("button", { type: "button", className: "to-place" }, sentence.trim());
    button.addEventListener("click", () => goTo(...place));
    return element("li", {}, button);
  }));
  return element("div", { className: "part" }, element("h3", {}, heading), list);
}

function showPrintouts() {
  const several = current.printouts.length > 1;
  page("paper-printouts").replaceChildren(...current.printouts.map((printout, at) => {
    const { verification } = printout;
    return element("section", { className: "printout" },
      element("h2", {}, several ? `Printout ${at + 1} (line ${verification.line})` : "What stands under it"),
      element("div", { className: "two" },
        element("div", { className: "parts" }, ...printout.parts.map(partList)),
        element("div", {},
          element("div", { className: "scroll", tabIndex: 0, role: "region", "aria-label": "Numbers" }, numbersTable(printout)),
          openInCollision(verification))));
  }));
}

/** A button that takes the scene recovered over to the Collision view. */
function openInCollision({ scene, guessed }) {
  if (Object.values(scene).some((text) => text === null)) return "";
  const button = element("button", { type: "button" }, "Open this collision");
  button.addEventListener("click", () => {
    dispatchEvent(new CustomEvent("desk-scene", { detail: { values: scene, title: current.name } }));
    location.hash = "#collision";
  });
  const note = guessed.length ? ` Not read exactly: ${guessed.join(" ")}.` : "";
  return element("p", { className: "over" }, button, note);
}

// --- the scan -----------------------------------------------------------------------------------

function showScan() {
  const frame = page("paper-scan-frame");
  const { scan } = current;
  page("paper-scan").hidden = !scan;
  page("paper-desk-top").classList.toggle("beside", Boolean(scan));
  page("paper-scan-note").hidden = !(current.pictured && current.answer);
  if (frame.dataset.shown === (scan?.address ?? "")) {
    showCells();
    return;
  }
  frame.dataset.shown = scan?.address ?? "";
  if (!scan) {
    frame.replaceChildren();
  } else if (!scan.pdf) {
    const image = element("img", { src: scan.address, alt: `Scan ${scan.name}` });
    image.addEventListener("load", showCells);
    frame.replaceChildren(element("div", { className: "scan-sheet" }, image));
  } else if (navigator.pdfViewerEnabled) {
    frame.replaceChildren(element("iframe", { src: `${scan.address}#page=1&view=FitH`, title: `Scan ${scan.name}` }));
  } else {
    frame.replaceChildren(element("p", { className: "note" }, `This browser shows no PDF: ${scan.name}. Save its page as a picture.`));
  }
  zoom();
}

const STATES = { holds: "as the program prints it", doubtful: "in doubt", differs: "differs" };
const SVG = "http://www.w3.org/2000/svg";

function drawn(name, properties, ...children) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(properties)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

/** The cells of the picture's numbers, outlined on it; one that is clicked is selected in the text. */
function showCells() {
  const sheet = page("paper-scan-frame").querySelector(".scan-sheet");
  const image = sheet?.querySelector("img");
  sheet?.querySelector("svg")?.remove();
  if (!image?.naturalWidth || !current.pictured || !current.answer) return;
  const boxes = [];
  for (const { verification } of current.printouts) {
    const counts = new Map();
    for (const cell of verification.cells ?? []) {
      const [left, top, right, bottom] = cell.box;
      const at = counts.get(cell.field) ?? 0;
      counts.set(cell.field, at + 1);
      const says = `${cell.field ?? "label"}: ${cell.predicted} expected, ${STATES[cell.state]}`
        + (cell.state === "holds" ? "" : `, looks like ${cell.runner_up === " " ? "blank" : cell.runner_up}`);
      const rect = drawn("rect", { x: left, y: top, width: right - left, height: bottom - top }, drawn("title", {}, says));
      const box = drawn("g", { class: `cell ${cell.state}` }, rect);
      if (cell.state === "differs") box.append(drawn("path", { d: `M${left} ${top}L${right} ${bottom}M${right} ${top}L${left} ${bottom}` }));
      const mark = current.marks.find((one) => one.check === verification.fields.find((check) => check.name === cell.field));
      if (cell.state !== "holds") {
        for (const [key, value] of [["tabindex", 0], ["role", "button"], ["aria-label", says]]) box.setAttribute(key, value);
      }
      if (mark) {
        const select = () => goTo(mark.start + at, mark.start + at + 1);
        box.addEventListener("click", select);
        box.addEventListener("keydown", (event) => event.key === "Enter" && select());
      }
      boxes.push(box);
    }
  }
  sheet.append(drawn("svg", { viewBox: `0 0 ${image.naturalWidth} ${image.naturalHeight}` }, ...boxes));
}

function zoom() {
  const picture = page("paper-scan-frame").firstElementChild;
  if (picture) picture.style.width = `${page("paper-zoom").value}%`;
}

function layScan(paper, file) {
  if (paper.scan) URL.revokeObjectURL(paper.scan.address);
  const pdf = file.type === "application/pdf" || /\.pdf$/i.test(file.name);
  paper.scan = { name: file.name, address: URL.createObjectURL(file), pdf };
  if (paper === current) showScan();
}

// --- bringing papers ----------------------------------------------------------------------------

function add(paper) {
  // the empty paper that waits for something to be pasted makes room
  if (papers.length === 1 && papers[0] === current && current.empty && !current.scan) papers.pop();
  papers.push(paper);
  return paper;
}

function fresh(name = `pasted ${(pasted += 1)}.txt`) {
  return add(new Paper(name, null, ""));
}

/** Files, from wherever they came: texts become papers, pictures are laid beside theirs or read themselves. */
function bring(files) {
  const sorted = [...files].sort((one, other) => one.name.localeCompare(other.name, undefined, { numeric: true }));
  const texts = sorted.filter((file) => !isPicture(file));
  const pictures = sorted.filter(isPicture);
  let first = null;
  for (const file of texts) first ??= add(new Paper(file.name, file));
  for (const file of texts.slice(1)) add(new Paper(file.name, file));
  for (const file of pictures) {
    const paper = papers.find((one) => !one.scan && stem(one.name) === stem(file.name))
      ?? (pictures.length === 1 && !texts.length && current && !current.scan && !current.empty ? current : null)
      ?? add(new Paper(file.name, file)); // it is read itself
    layScan(paper, file);
    first ??= paper;
  }
  if (first) choose(first);
  judgeAll();
}

async function filesOf(entry) {
  if (entry.isFile) return [await new Promise((resolve, reject) => entry.file(resolve, reject))];
  const reader = entry.createReader();
  const found = [];
  for (;;) {
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (!some.length) break;
    for (const one of some) found.push(...await filesOf(one));
  }
  return found.filter((file) => !file.name.startsWith("."));
}

async function dropped(event) {
  const items = [...event.dataTransfer.items].filter((item) => item.kind === "file");
  const entries = items.map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (entries.length) {
    const files = await Promise.all(entries.map(filesOf));
    bring(files.flat());
  } else if (event.dataTransfer.files.length) {
    bring(event.dataTransfer.files);
  } else {
    const text = event.dataTransfer.getData("text/plain");
    if (text) pasteAs(text);
  }
}

function pasteAs(text) {
  const paper = current?.empty ? current : fresh();
  paper.text = text;
  choose(paper);
  judge(paper, "edit");
}

const shownHere = () => !page("paper").hidden;

function listen() {
  addEventListener("dragover", (event) => {
    if (!shownHere()) return;
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) document.body.classList.remove("dropping");
  });
  addEventListener("drop", (event) => {
    document.body.classList.remove("dropping");
    if (!shownHere()) return;
    event.preventDefault();
    dropped(event);
  });
  addEventListener("paste", (event) => {
    if (!shownHere() || event.target.closest?.("input, textarea")) return;
    if (event.clipboardData.files.length) bring(event.clipboardData.files);
    else if (event.clipboardData.getData("text/plain")) pasteAs(event.clipboardData.getData("text/plain"));
  });
}

function edited() {
  const text = page("paper-text");
  current.marks = shifted(current.marks, current.text ?? "", text.value);
  current.text = text.value;
  current.edited = true;
  current.trouble = "";
  showMarks();
  page("paper-revert").hidden = !current.file;
  page("paper-save").disabled = !current.text;
  judgeEdited();
}

async function base64(blob) {
  const address = await new Promise((resolve) => {
    const reader = new FileReader();
    reader.addEventListener("load", () => resolve(reader.result));
    reader.readAsDataURL(blob);
  });
  return address.slice(address.indexOf(",") + 1);
}

async function saveReport() {
  const trouble = page("paper-report-trouble");
  tell(trouble, null);
  try {
    const given = papers.filter((paper) => !paper.empty);
    const sent = await Promise.all(given.map(async (paper) => ({ name: paper.name, data: await base64(paper.body) })));
    const words = Object.fromEntries([...document.querySelectorAll(".report input")].map((input) => [input.name, input.value]));
    const response = await watched(page("paper-busy"), "Writing the report", "edit", ask("report", { papers: sent, words }));
    if (response) await save(response);
  } catch (error) {
    tell(trouble, error);
  }
}

/** Start the view. */
export function paper() {
  choose(fresh());
  listen();
  page("paper-text").addEventListener("input", edited);
  document.addEventListener("selectionchange", () => {
    if (document.activeElement === page("paper-text")) showHere();
  });
  for (const [button, input] of [["paper-open", "paper-files"], ["paper-folder", "paper-folders"]]) {
    page(button).addEventListener("click", () => page(input).click());
    page(input).addEventListener("change", (event) => {
      bring(event.target.files);
      event.target.value = "";
    });
  }
  page("paper-new").addEventListener("click", () => {
    if (!current.empty) choose(fresh());
    page("paper-text").focus();
  });
  page("paper-published").addEventListener("change", async (event) => {
    const name = event.target.value;
    event.target.value = "";
    const response = name && await ask(`published/${name}`).catch(() => null);
    if (response) bring([new File([await response.blob()], name, { type: "text/plain" })]);
  });
  page("paper-print").addEventListener("click", () => print());
  page("paper-save").addEventListener("click", () => save(new Response(current.text, {
    headers: { "Content-Disposition": `attachment; filename="${current.name.replaceAll('"', "")}"` },
  })));
  page("paper-revert").addEventListener("click", () => {
    Object.assign(current, { edited: false, text: null, answer: null, trouble: "" });
    judge(current, "edit");
  });
  page("paper-remove").addEventListener("click", () => {
    const at = papers.indexOf(current);
    if (current.scan) URL.revokeObjectURL(current.scan.address);
    papers.splice(at, 1);
    stop("edit");
    stop("paper");
    choose(papers[Math.min(at, papers.length - 1)] ?? fresh());
  });
  page("paper-add-scan").addEventListener("click", () => page("paper-scan-file").click());
  page("paper-scan-file").addEventListener("change", (event) => {
    const [file] = event.target.files;
    if (file) layScan(current, file);
  });
  page("paper-scan-away").addEventListener("click", () => {
    URL.revokeObjectURL(current.scan.address);
    current.scan = null;
    showScan();
  });
  page("paper-zoom").addEventListener("input", zoom);
  page("paper-report").addEventListener("click", saveReport);
}
