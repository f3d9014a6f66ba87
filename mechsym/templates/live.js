"use strict";
/* Panels of curves with a cursor that reads values, linked over all figures, and zoom; the vector figure stays for print. */
(() => {
  const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const narrow = matchMedia("(max-width: 44rem)"), plots = [];
  let zoom; // one range for all panels over the same value

  /* The points of a curve, out of the path that draws it. */
  function points(path, p) {
    const n = path.getAttribute("d").match(/-?\d[\d.]*(?:e-?\d+)?/g).map(Number), [l, b, r, t] = p.at;
    const take = (k, from, to, [low, high]) => n.filter((_, i) => i % 2 === k).map(v => low + (v - from) / (to - from) * (high - low));
    return { x: take(0, l, r, p.x), y: take(1, b, t, p.y) };
  }
  /* Several curves over all places at which one of them bends. */
  function joined(curves) {
    const xs = [...new Set(curves.flatMap(c => c.x))].sort((a, b) => a - b);
    const over = ({ x, y }) => {
      let i = 0;
      return xs.map(v => {
        if (v < x[0] || v > x[x.length - 1]) return null;
        while (i < x.length - 2 && x[i + 1] < v) i++;
        return x[i + 1] === x[i] ? y[i] : y[i] + (v - x[i]) / (x[i + 1] - x[i]) * (y[i + 1] - y[i]);
      });
    };
    return [xs, ...curves.map(over)];
  }
  const read = (value, low, high) => value == null ? "" : value.toFixed(Math.max(0, 3 - Math.floor(Math.log10(high - low || 1))));

  function plot(box, p, svg) {
    const lines = p.curves.map(([k]) => svg.querySelector(`[data-curve="${k}"] path`));
    const look = k => getComputedStyle(lines[k]), data = joined(lines.map(line => points(line, p)));
    const turn = /^(crank|shaft) angle.*\[deg\]/.test(p.across), ink = () => css("--quiet"), grid = () => css("--line");
    const incrs = turn ? [5, 10, 15, 30, 45, 60, 90, 180, 360] : undefined;
    const named = 6 * Math.max(0, ...p.marks.map(([, name]) => name.length)); // room for what stands above
    const whole = u => u.scales.x.min == null || (u.scales.x.min <= p.x[0] && u.scales.x.max >= p.x[1]);
    const wide = () => Math.max(220, box.clientWidth), high = () => named + Math.round(Math.min(340, Math.max(190, 0.62 * wide())));
    const marks = u => {
      const { ctx, bbox } = u, ratio = devicePixelRatio;
      ctx.save(); ctx.strokeStyle = ctx.fillStyle = ink(); ctx.lineWidth = ratio; ctx.textAlign = "left"; ctx.textBaseline = "alphabetic"; ctx.font = `${11 * ratio}px system-ui, sans-serif`; ctx.setLineDash([2 * ratio, 3 * ratio]);
      let place = 0; // a name keeps clear of the one before it
      for (const [x, name] of p.marks) {
        const at = u.valToPos(x, "x", true);
        if (at < bbox.left || at > bbox.left + bbox.width) continue;
        ctx.beginPath(); ctx.moveTo(at, bbox.top); ctx.lineTo(at, bbox.top + bbox.height); ctx.stroke();
        place = Math.max(place, at);
        ctx.save(); ctx.translate(place + 4 * ratio, bbox.top - 4 * ratio); ctx.rotate(-Math.PI / 2); ctx.fillText(name, 0, 0); ctx.restore();
        if (name) place += 13 * ratio;
      }
      ctx.restore();
    };
    const u = new uPlot({
      width: wide(), height: high(), padding: [8 + named, 12, 0, 0],
      scales: { x: { time: false, range: (_, low, high) => low === high || low == null || (low <= data[0][0] && high >= data[0].at(-1)) ? p.x : [Math.max(low, p.x[0]), Math.min(high, p.x[1])] },
                y: { range: (u, low, high) => whole(u) || low == null ? p.y : uPlot.rangeNum(low, high, 0.1, true) } },
      axes: [{ label: p.across, stroke: ink, grid: { stroke: grid, width: 1 }, ticks: { stroke: grid }, incrs, size: 34, labelSize: 22, font: "11px system-ui", labelFont: "12px system-ui" },
             { label: p.up, stroke: ink, grid: { stroke: grid, width: 1 }, ticks: { stroke: grid }, size: 58, labelSize: 20, font: "11px system-ui", labelFont: "12px system-ui",
               values: (_, ticks) => ticks.map(v => String(+v.toPrecision(6))) }],
      series: [{ label: p.across, value: (_, v) => read(v, ...p.x) },
        ...p.curves.map(([, name], k) => ({ label: name, class: name ? "u-named" : "u-level", value: (_, v) => read(v, ...p.y), spanGaps: false,
          stroke: () => look(k).stroke, width: Math.max(1, 1.2 * parseFloat(look(k).strokeWidth)),
          dash: /\d/.test(look(k).strokeDasharray) ? look(k).strokeDasharray.match(/[\d.]+/g).map(v => 1.3 * v) : undefined, pxAlign: 0, points: { show: false } }))],
      legend: { markers: { width: 2, dash: (_, k) => k && /\d/.test(look(k - 1).strokeDasharray) ? "dashed" : "solid" } },
      cursor: { sync: { key: p.across }, drag: { x: true, y: false }, points: { size: 6 } },
      hooks: { draw: [marks],
        setCursor: [u => { if (turn && u.cursor.event) crank(u.cursor.left >= 0 ? u.posToVal(u.cursor.left, "x") : null); }],
        setScale: [(u, key) => { if (key === "x" && !zoom) spread(u, p.across); }] },
    }, data, box);
    plots.push({ u, p, size: () => u.setSize({ width: wide(), height: high() }) });
    u.over.title = "drag to zoom, double click for all";
  }
  /* The range that was chosen in one panel is that of all over the same value. */
  function spread(from, across) {
    zoom = true;
    const { min, max } = from.scales.x;
    for (const { u, p } of plots) if (u !== from && p.across === across && u.status) u.setScale("x", { min, max });
    setTimeout(() => { zoom = false; });
  }
  /* The machine of the page stands where the cursor reads. */
  const crank = degrees => document.querySelectorAll(".turning").forEach(box => box.dispatchEvent(new CustomEvent("crank", { detail: degrees })));

  for (const svg of document.querySelectorAll("svg[data-panels]")) {
    const { columns, panels } = JSON.parse(svg.dataset.panels), box = Object.assign(document.createElement("div"), { className: "live" });
    box.style.setProperty("--columns", columns);
    svg.classList.add("drawn");
    svg.after(box);
    for (const p of panels) {
      const panel = box.appendChild(document.createElement("div"));
      if (p.head) panel.appendChild(Object.assign(document.createElement("b"), { textContent: p.head }));
      if (p.curves) { panel.setAttribute("role", "img"); panel.setAttribute("aria-label", [p.head, `${p.up} over ${p.across}`].filter(Boolean).join(", ")); plot(panel, p, svg); continue; }
      const part = svg.cloneNode(true);
      part.setAttribute("viewBox", p.crop.join(" "));
      part.classList.remove("drawn"); part.removeAttribute("width"); part.removeAttribute("height");
      part.removeAttribute("data-panels"); part.removeAttribute("data-columns");
      panel.append(part);
    }
  }
  let resized;
  addEventListener("resize", () => { clearTimeout(resized); resized = setTimeout(() => plots.forEach(one => one.size()), 100); });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => plots.forEach(({ u }) => u.redraw(false)));
  window.mechsymPlots = plots;
})();
