// Marks in a text that is edited: drawn behind the editor, and moved along as the text changes.
import { element } from "./ask.js";

const LONGEST_MARKED = 400_000; // characters; beyond this the text is shown without marks

/**
 * A function from the program's offsets in a text to the browser's: the one counts characters, the
 * other counts those beyond the first 65,536 of Unicode twice.
 */
export function offsetsIn(text) {
  if (!/[\ud800-\udfff]/.test(text)) return (offset) => offset;
  const places = [];
  let place = 0;
  for (const character of text) {
    places.push(place);
    place += character.length;
  }
  return (offset) => places[offset] ?? place;
}

/** The marks of `before` where they stand in `after`; those inside the change are gone. */
export function shifted(marks, before, after) {
  const shorter = Math.min(before.length, after.length);
  let same = 0;
  while (same < shorter && before[same] === after[same]) same += 1;
  let tail = 0;
  while (tail < shorter - same && before[before.length - 1 - tail] === after[after.length - 1 - tail]) tail += 1;
  const end = before.length - tail;
  const moved = after.length - before.length;
  return marks.flatMap((mark) => {
    if (mark.stop < same) return [mark];
    if (mark.start > end) return [{ ...mark, start: mark.start + moved, stop: mark.stop + moved }];
    return [];
  });
}

/** Draw a text with its marks, and its line numbers. */
export function draw(place, numbers, text, marks) {
  const pieces = [];
  let at = 0;
  for (const mark of text.length > LONGEST_MARKED ? [] : marks) {
    if (mark.start < at || mark.stop > text.length || mark.stop === mark.start) continue;
    pieces.push(text.slice(at, mark.start), whole(text, mark));
    at = mark.stop;
  }
  // the last line end needs a character after it to take up a line
  pieces.push(text.slice(at), "\u200b");
  place.replaceChildren(...pieces);
  const lines = text.split("\n").length;
  if (numbers.dataset.lines !== String(lines)) {
    numbers.dataset.lines = String(lines);
    numbers.textContent = Array.from({ length: lines }, (_, place_) => place_ + 1).join("\n");
  }
}

/** One mark, with the doubtful characters inside it marked again. */
function whole(text, mark) {
  const marked = element("mark", { className: mark.kind });
  let at = mark.start;
  for (const doubt of mark.doubts ?? []) {
    const stop = doubt.start + Math.max(doubt.read.length, 1);
    if (doubt.start < at || stop > mark.stop) continue;
    marked.append(text.slice(at, doubt.start), element("b", {}, text.slice(doubt.start, stop)));
    at = stop;
  }
  marked.append(text.slice(at, mark.stop));
  return marked;
}
