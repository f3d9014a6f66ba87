/* One crank angle for charts and picture: a pointer over a chart turns the picture, the turning picture moves a line. */
const mechsymCharts = new Map();

function mechsymPoint(crank) {
  for (const [id, { chart, ratio }] of mechsymCharts) {
    if (chart.isDisposed()) { mechsymCharts.delete(id); continue; }
    const x = chart.convertToPixel({ xAxisIndex: 0 }, crank * ratio);
    if (!isFinite(x)) continue;
    chart.setOption({ graphic: [{ id: "cursor", type: "line", silent: true, z: 100, style: { stroke: "#888", lineWidth: 1 },
      shape: { x1: x, x2: x, y1: 30, y2: chart.getHeight() - 40 } }] });
  }
}

function mechsymLink(id, ratio, tries = 50) {
  const chart = getElement(id)?.chart;
  if (!chart) { if (tries) setTimeout(() => mechsymLink(id, ratio, tries - 1), 100); return; }
  mechsymCharts.set(id, { chart, ratio });
  const tell = message => document.querySelectorAll("iframe").forEach(f => f.contentWindow.postMessage(message, "*"));
  chart.getZr().on("mousemove", e => {
    const crank = chart.convertFromPixel({ xAxisIndex: 0 }, e.offsetX) / ratio;
    if (isFinite(crank)) tell({ hold: crank });
  });
  chart.getZr().on("globalout", () => tell({ go: true }));
}

addEventListener("message", e => { if (e.data && typeof e.data.crank === "number") mechsymPoint(e.data.crank); });
