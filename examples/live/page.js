"use strict";
const token = document.querySelector("meta[name=token]").content;
const $ = id => document.getElementById(id);
const say = text => { $("said").textContent = text; };
let size = {width: 512, height: 512};
let frame = null, pointer = null, begun = false;

async function post(path, body) {
  const answer = await fetch(path, {
    method: "POST", body: JSON.stringify(body),
    headers: {"Content-Type": "application/json", "X-Freqsynth-Token": token}
  });
  const text = await answer.text();
  if (!answer.ok) throw new Error(text);
  return text;
}

// What is newest goes when the last one has arrived, a tenth of a second later at most.
function latest(path) {
  let next = null, busy = false;
  return async body => {
    next = body;
    if (busy) return;
    busy = true;
    while (next !== null) {
      const now = next;
      next = null;
      try { await post(path, now); } catch (error) { say("Not done: " + error.message); }
      await new Promise(done => setTimeout(done, 100));
    }
    busy = false;
  };
}
const attend = latest("/attention"), look = latest("/view");

// The frame, in pixels of the picture: left, top, right, bottom.
function showFrame() {
  $("frame").hidden = !frame;
  if (!frame) {
    $("frame-text").textContent = "There is no frame.";
    return;
  }
  const [left, top, right, bottom] = frame.map(Math.round);
  Object.assign($("frame").style, {
    left: 100 * left / size.width + "%", top: 100 * top / size.height + "%",
    width: 100 * (right - left) / size.width + "%", height: 100 * (bottom - top) / size.height + "%"
  });
  $("frame-text").textContent =
    `Frame of ${right - left} by ${bottom - top} pixels, ${left} from the left, ${top} from the top.`;
}
function setFrame(next) {
  frame = next;
  showFrame();
  attend({frame, pointer});
}
const sayFrame = () => say($("frame-text").textContent);
function middleFrame() {
  setFrame([size.width / 4, size.height / 4, 3 * size.width / 4, 3 * size.height / 4]);
  sayFrame();
}
function noFrame() {
  setFrame(null);
  sayFrame();
}

// The mouse: it points, and draws frames.
let corner = null;
function place(event) {
  const box = $("region").getBoundingClientRect();
  const within = (value, most) => Math.min(Math.max(value, 0), most);
  return [within((event.clientX - box.left) / box.width * size.width, size.width),
          within((event.clientY - box.top) / box.height * size.height, size.height)];
}
const between = (a, b) => [Math.min(a[0], b[0]), Math.min(a[1], b[1]),
                           Math.max(a[0], b[0]), Math.max(a[1], b[1])];
$("region").addEventListener("pointerdown", event => {
  if (event.button !== 0) return;
  $("region").setPointerCapture(event.pointerId);
  corner = place(event);
});
$("region").addEventListener("pointermove", event => {
  pointer = place(event);
  if (corner) {
    const next = between(corner, pointer);
    if (next[2] - next[0] >= 4 && next[3] - next[1] >= 4) frame = next;
    showFrame();
  }
  attend({frame, pointer});
});
$("region").addEventListener("pointerup", event => {
  if (!corner) return;
  const next = between(corner, place(event));
  corner = null;
  if (next[2] - next[0] >= 4 && next[3] - next[1] >= 4) {
    setFrame(next);
    sayFrame();
  }
});
$("region").addEventListener("pointercancel", () => { corner = null; });
$("region").addEventListener("pointerleave", () => {
  pointer = null;
  attend({frame, pointer});
});

// The keyboard does the same in steps of a block.
$("region").addEventListener("keydown", event => {
  const steps = {ArrowLeft: [-8, 0], ArrowRight: [8, 0], ArrowUp: [0, -8], ArrowDown: [0, 8]};
  if (event.key === "Enter" || event.key === " ") middleFrame();
  else if (event.key === "Escape" || event.key === "Delete") noFrame();
  else if (event.key in steps) {
    if (!frame) middleFrame();
    const [x, y] = steps[event.key];
    let [left, top, right, bottom] = frame;
    right = Math.min(right + x, size.width);
    bottom = Math.min(bottom + y, size.height);
    if (event.shiftKey) {
      right = Math.max(right, left + 8);
      bottom = Math.max(bottom, top + 8);
    } else {
      const width = frame[2] - left, height = frame[3] - top;
      left = Math.max(right - width, 0);
      top = Math.max(bottom - height, 0);
      right = left + width;
      bottom = top + height;
    }
    setFrame([left, top, right, bottom]);
    sayFrame();
  } else return;
  event.preventDefault();
});
$("make").addEventListener("click", middleFrame);
$("clear").addEventListener("click", noFrame);

// Sliders and the button.
function showLook() {
  const stops = Number($("stops").value);
  $("stops-text").textContent = (stops > 0 ? "+" : "") + stops + (Math.abs(stops) === 1 ? " stop" : " stops");
  $("stops").setAttribute("aria-valuetext", $("stops-text").textContent);
  $("quality-text").textContent = $("quality").value;
}
for (const id of ["stops", "quality"]) {
  $(id).addEventListener("input", () => {
    showLook();
    look({stops: Number($("stops").value), quality: Number($("quality").value)});
  });
}
$("store").addEventListener("click", async () => {
  say("Storing.");
  try { say("Stored: " + await post("/store", {}) + "."); }
  catch (error) { say("Not stored: " + error.message); }
});

// A picture is exchanged when it is there, so that nothing flickers; one at a time, and then the newest.
async function fetchPicture(id, revision, alt) {
  const next = new Image();
  next.src = `/${id}.jpg?revision=${revision}`;
  try { await next.decode(); } catch (error) { return; }
  $(id).src = next.src;
  $(id).alt = alt;
}
function showState(state) {
  const rate = state.samples_per_pixel.toFixed(2);
  $("samples").textContent = state.samples.toLocaleString("en");
  $("rate").textContent = rate;
  $("seconds").textContent = state.seconds.toFixed(1);
  $("rmse").textContent = state.error === null ? "unknown" : state.error.toFixed(2) + " of 255";
  $("revision").textContent = state.revision;
  $("state").textContent = state.finished ? "finished" : "sampling";
  $("most").textContent = state.most_samples;
}
function begin(state) {
  begun = true;
  size = {width: state.width, height: state.height};
  $("scene").textContent = `${state.scene}, ${state.width} × ${state.height}`;
  document.title = `${state.scene} – freqsynth live`;
  for (const id of ["picture", "density", "error"]) {
    $(id).width = state.width;
    $(id).height = state.height;
  }
  $("stops").value = state.stops;
  $("quality").value = state.quality;
  frame = state.frame;
  showLook();
  showFrame();
}
let told = 0, finished = false;
function tell(state, text) {
  // Not each revision: a screen reader would never be silent.
  const now = Date.now();
  if (state.finished !== finished || now - told > 20000) {
    told = now;
    finished = state.finished;
    say(finished ? "Finished: " + text : text);
  }
}
async function watch() {
  let revision = 0;
  for (;;) {
    try {
      // The first answer comes at once, whatever there is.
      const state = await (await fetch(begun ? `/state?after=${revision}` : "/state")).json();
      if (!begun) begin(state);
      if (state.revision > revision || state.revision < revision - 1) {
        revision = state.revision;
        showState(state);
        const text = `${state.scene} after ${state.samples_per_pixel.toFixed(2)} samples per pixel` +
          (state.error === null ? "" : `, expected error ${state.error.toFixed(1)} of 255 levels`) + ".";
        await Promise.all([
          fetchPicture("picture", revision, `Picture of the scene ${text}`),
          fetchPicture("density", revision,
            `Where samples were taken: white blocks have ${state.most_samples}, black ones none.`),
          state.error === null ? null : fetchPicture("error", revision,
            `Where errors are expected: ${state.error.toFixed(1)} of 255 levels on average; bright blocks have more.`)
        ]);
        tell(state, text);
      }
    } catch (error) {
      $("state").textContent = "no answer";
      await new Promise(done => setTimeout(done, 1000));
    }
  }
}
showLook();
watch();
