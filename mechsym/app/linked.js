/* One crank angle for charts and picture: a pointer over a chart turns the picture, the turning picture moves a line. */
const mechsymCharts = new Map();
const mechsymTell = message => document.querySelectorAll("iframe").forEach(f => f.contentWindow.postMessage(message, "*"));

function mechsymPoint(crank) {
  for (const [id, { chart, ratio, line }] of mechsymCharts) {
    if (chart.isDisposed()) { mechsymCharts.delete(id); continue; }
    const x = Math.round(chart.convertToPixel({ xAxisIndex: 0 }, crank * ratio));
    // an element of its own: a line inside the chart would draw all of it again
    if (isFinite(x)) line.style.transform = `translateX(${x}px)`;
  }
}

function mechsymLink(id, ratio, tries = 50) {
  const chart = getElement(id)?.chart;
  if (!chart) { if (tries) setTimeout(() => mechsymLink(id, ratio, tries - 1), 100); return; }
  const line = Object.assign(document.createElement("div"), { className: "mechsym-cursor" });
  chart.getDom().append(line);
  mechsymCharts.set(id, { chart, ratio, line });
  chart.getZr().on("mousemove", e => {
    const crank = chart.convertFromPixel({ xAxisIndex: 0 }, e.offsetX) / ratio;
    if (isFinite(crank)) mechsymTell({ hold: crank });
  });
  chart.getZr().on("globalout", () => mechsymTell({ go: true }));
}

addEventListener("message", e => { if (e.data && typeof e.data.crank === "number") mechsymPoint(e.data.crank); });

/* The picture rests while a slider moves, so that the answer has the processor. */
let mechsymResting;
for (const kind of ["pointerdown", "pointermove", "keydown"])
  addEventListener(kind, e => {
    if (!e.target.closest?.(".q-slider") || (kind === "pointermove" && !e.buttons)) return;
    mechsymTell({ rest: true });
    clearTimeout(mechsymResting);
    mechsymResting = setTimeout(() => mechsymTell({ go: true }), 1500);
  }, true);

/* The address holds case, tab and values; the browser is told once they rest. */
let mechsymAsked;
function mechsymAddress(address) {
  clearTimeout(mechsymAsked);
  mechsymAsked = setTimeout(() => history.replaceState(null, "", address), 300);
}
