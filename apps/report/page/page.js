// What the page does beyond what stands in it: plots that can be pointed at, switches, sorting, the wipe.
"use strict";
(() => {
  const points = JSON.parse(document.getElementById("points").textContent);
  const controls = document.querySelector(".controls");
  const parts = [...document.querySelectorAll(".light")];
  // Okabe and Ito 2008: told apart by every kind of colour vision. plot_svg.cpp has the same.
  const colors = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8b6f47", "#7f7f7f", "#882255", "#44aa99"];
  const shapes = ["circle", "triangle", "rect", "rectRot", "star", "crossRot", "cross", "rectRounded"];
  const leastShown = 1e-5;
  const techniques = [...new Set(points.map((point) => point.technique))].sort();  // of one colour in every plot

  const label = (point) => point.technique + (point.varied ? " " + point.varied : "");
  const figure = (value) => Number(value).toPrecision(3).replace(/^(.*)e\+?(.*)$/, (_, m, e) => String(m * 10 ** e));
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const asked = () => ({ light: controls.elements.light.value, metric: controls.elements.metric.value });
  const metricName = () => controls.elements.metric.selectedOptions[0].textContent;

  function errorOf(point, metric) {
    if (!point.metrics) return NaN;
    const value = metric === "dssim" ? 1 - point.metrics.ssim : point.metrics[metric];
    return value === undefined || value === null ? NaN : Math.max(value, leastShown);
  }

  function pointsOf(part, metric) {
    return points
      .filter((p) => p.scene === part.dataset.scene && p.light === part.dataset.light && p.frame_ms)
      .map((p) => ({ x: p.frame_ms.median, y: errorOf(p, metric), point: p }))
      .filter((p) => Number.isFinite(p.y))
      .sort((a, b) => a.x - b.x || a.y - b.y);
  }

  function frontOf(sorted) {
    let best = Infinity;
    return sorted.filter((p) => p.y < best && ((best = p.y), true));
  }

  function describe(item) {
    const { min, max } = item.point.frame_ms;
    const energy = item.point.metrics.ratio;
    return [label(item.point) + (item.point.one_bounce ? " (one bounce)" : ""),
      `${figure(item.x)} ms (${figure(min)} to ${figure(max)}), ${metricName()}: ${figure(item.y)}`,
      energy === undefined ? "" : `energy ${figure(energy)}`].filter(Boolean);
  }

  function datasets(part, metric) {
    const sorted = pointsOf(part, metric);
    const sets = techniques.flatMap((name, i) => {
      const data = sorted.filter((p) => p.point.technique === name);
      return !data.length ? [] : {
        label: name, data, backgroundColor: colors[i % colors.length], borderColor: colors[i % colors.length],
        pointStyle: shapes[i % shapes.length], pointBorderWidth: 2,
        pointRadius: data.map((p) => (p.point.varied ? 4 : 7)), pointHoverRadius: 10, pointHitRadius: 6,
      };
    });
    sets.push({
      label: "front", data: frontOf(sorted).map(({ x, y }) => ({ x, y })), type: "line", stepped: true, pointRadius: 0,
      pointHitRadius: 0, pointHoverRadius: 0, borderColor: css("--text"), borderWidth: 1.5, borderDash: [5, 3],
      pointStyle: "line",
    });
    return sets;
  }

  // 1, 2 and 5 of every decade.
  const isRound = (v) => [1, 2, 5].some((digit) => Math.abs(v / 10 ** Math.floor(Math.log10(v) + 1e-9) - digit) < 1e-6);

  const axis = (text, values) => ({
    type: "logarithmic", min: Math.min(...values) / 1.25, max: Math.max(...values) * 1.25, title: { display: true, text, color: css("--text") },
    ticks: { color: css("--text"), maxRotation: 0, callback: (v) => (isRound(v) ? figure(v) : "") },
    grid: { color: css("--line") },
  });

  function options(part) {
    const shown = pointsOf(part, asked().metric);
    return {
      animation: false, responsive: true, maintainAspectRatio: false, parsing: false,
      interaction: { mode: "nearest", intersect: true },
      scales: {
        x: axis("time per frame [ms]", shown.map((item) => item.x)), y: axis(metricName(), shown.map((item) => item.y)),
      },
      plugins: {
        legend: { labels: { color: css("--text"), usePointStyle: true } },
        tooltip: {
          filter: (item) => Boolean(item.raw.point),
          callbacks: { title: () => "", label: (item) => describe(item.raw) },
        },
      },
      onClick: (_, elements, chart) => {
        const item = elements.map((e) => chart.data.datasets[e.datasetIndex].data[e.index]).find((d) => d.point);
        if (item) choose(part, item);
      },
    };
  }

  function show(part) {
    const { metric } = asked();
    if (!pointsOf(part, metric).length) return;
    if (typeof Chart === "undefined") return;
    part.querySelector(".canvas").hidden = false;
    part.querySelector(".plot-svg")?.remove();
    const canvas = part.querySelector("canvas");
    const chart = Chart.getChart(canvas) || new Chart(canvas, { type: "scatter", data: { datasets: [] }, options: options(part) });
    chart.data.datasets = datasets(part, metric);
    chart.options = options(part);
    chart.update();
    if (canvas.dataset.keys) return;
    canvas.dataset.keys = "on";
    canvas.addEventListener("keydown", (event) => walk(event, part, chart));
    canvas.addEventListener("focus", () => walk({ key: "" }, part, chart));
    canvas.addEventListener("blur", () => { chart.tooltip.setActiveElements([], { x: 0, y: 0 }); chart.setActiveElements([]); chart.update(); });
  }

  // Arrow keys: from point to point by time, through all techniques that are shown.
  function walk(event, part, chart) {
    const all = chart.data.datasets.flatMap((set, datasetIndex) => (chart.isDatasetVisible(datasetIndex)
      ? set.data.map((item, index) => ({ item, datasetIndex, index })).filter((e) => e.item.point) : []))
      .sort((a, b) => a.item.x - b.item.x);
    if (!all.length) return;
    const canvas = chart.canvas;
    const last = all.length - 1;
    const at = Math.min(Number(canvas.dataset.at || 0), last);
    const to = { ArrowRight: Math.min(at + 1, last), ArrowLeft: Math.max(at - 1, 0), ArrowUp: Math.min(at + 1, last),
      ArrowDown: Math.max(at - 1, 0), Home: 0, End: last, Enter: at, " ": at, "": at }[event.key];
    if (to === undefined) return;
    if (event.preventDefault) event.preventDefault();
    canvas.dataset.at = to;
    const { item, datasetIndex, index } = all[to];
    const element = chart.getDatasetMeta(datasetIndex).data[index];
    chart.setActiveElements([{ datasetIndex, index }]);
    chart.tooltip.setActiveElements([{ datasetIndex, index }], { x: element.x, y: element.y });
    chart.update();
    part.querySelector(".readout").textContent = describe(item).join("; ");
    if (event.key === "Enter" || event.key === " ") choose(part, item);
  }

  function choose(part, item) {
    part.querySelector(".readout").textContent = describe(item).join("; ");
    for (const row of part.querySelectorAll("tr.chosen")) row.classList.remove("chosen");
    part.querySelector(`tr[data-key="${item.point.key}"]`)?.classList.add("chosen");
    const select = part.querySelector(".viewer select[name=point]");
    if (select && [...select.options].some((o) => o.value === item.point.key)) {
      select.value = item.point.key;
      select.dispatchEvent(new Event("change"));
    }
  }

  const element = (html) => Object.assign(document.createElement("template"), { innerHTML: html }).content.firstElementChild;

  // Pixels of a picture that holds radiance: mantissas on the left, exponents on the right (measure.cpp).
  async function radianceOf(image) {
    if (!image?.dataset.radiance) return null;
    const packed = new Image();
    packed.src = image.dataset.radiance;
    await packed.decode();
    const [width, height] = [packed.naturalWidth / 2, packed.naturalHeight];
    const context = Object.assign(document.createElement("canvas"), { width: 2 * width, height }).getContext("2d");
    context.drawImage(packed, 0, 0);
    const bytes = context.getImageData(0, 0, 2 * width, height).data;
    const pixel = (x, y) => {
      const at = 4 * (2 * width * y + x);
      const scale = 2 ** (bytes[at + 4 * width] - 136);
      return [0, 1, 2].map((c) => bytes[at + c] * scale);
    };
    return { width, height, pixel };
  }

  // Khronos PBR Neutral, as core's tone_map().
  function toneMapped(color) {
    const least = Math.min(...color);
    const offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
    const shifted = color.map((c) => c - offset);
    const [start, desaturation] = [0.8 - 0.04, 0.15];
    const peak = Math.max(...shifted);
    if (peak < start) return shifted;
    const d = 1 - start;
    const newPeak = 1 - (d * d) / (peak + d - start);
    const g = 1 - 1 / (desaturation * (peak - newPeak) + 1);
    return shifted.map((c) => ((c * newPeak) / peak) * (1 - g) + newPeak * g);
  }

  const encoded = (c) => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);

  function exposed(radiance, ev) {
    const { width, height, pixel } = radiance;
    const canvas = Object.assign(document.createElement("canvas"), { width, height });
    const context = canvas.getContext("2d");
    const out = context.createImageData(width, height);
    for (let i = 0; i < width * height; ++i) {
      const shown = toneMapped(pixel(i % width, Math.floor(i / width)).map((c) => c * 2 ** ev)).map(encoded);
      out.data.set([...shown.map((c) => Math.round(255 * Math.min(Math.max(c, 0), 1))), 255], 4 * i);
    }
    context.putImageData(out, 0, 0);
    return canvas.toDataURL();
  }

  // Two pictures over one another, and a slider for where one ends; exposure, zoom and the values under the pointer.
  function makeViewer(part) {
    const viewer = part.querySelector(".viewer");
    const triples = [...part.querySelectorAll(".triple[data-key]")];
    const reference = part.querySelector("img[data-role=reference]");
    if (!reference || !triples.length) return;
    const roles = '<option value="reference">reference</option><option value="result">result</option><option value="error">error map</option>';
    viewer.append(
      element(`<div class="choices"><label>Point <select name="point"></select></label>
        <label>Left <select name="left">${roles}</select></label><label>Right <select name="right">${roles}</select></label>
        <label>Zoom <select name="zoom"><option value="1">1×</option><option value="2">2×</option><option value="4">4×</option><option value="8">8×</option></select></label>
        <label>Exposure <input name="exposure" type="range" min="-6" max="6" step="0.5" value="0"> <output>0 EV</output></label></div>`),
      element('<div class="wipe"><img class="under" alt="" draggable="false"><div class="over"><img alt="" draggable="false"></div></div>'),
      element('<p class="values"></p>'),
      element('<input type="range" min="0" max="100" value="50" aria-label="Wipe between the left and the right picture">'));
    const [point, left, right, zoom] = viewer.querySelectorAll("select");
    const exposure = viewer.querySelector("input[name=exposure]");
    const values = viewer.querySelector(".values");
    const [under, over] = viewer.querySelectorAll("img");
    const wipe = viewer.querySelector(".wipe");
    const slider = viewer.querySelector("input:not([name])");
    for (const triple of triples) point.add(new Option(triple.dataset.label, triple.dataset.key));
    const own = triples.find((t) => "baseline" in t.dataset);
    if (own) point.value = own.dataset.key;
    right.value = "result";
    const picture = (role) => (role === "reference" ? reference
      : part.querySelector(`.triple[data-key="${point.value}"] img[data-role=${role}]`));
    const unpacked = new Map();
    const radiance = (role) => {
      const from = picture(role);
      if (!unpacked.has(from)) unpacked.set(from, radianceOf(from));
      return unpacked.get(from);
    };
    const update = async () => {
      wipe.style.setProperty("--at", slider.value + "%");
      const ev = Number(exposure.value);
      const base = Number(triples.find((t) => t.dataset.key === point.value).dataset.exposure);
      viewer.querySelector("output").textContent = `${ev > 0 ? "+" : ""}${ev} EV`;
      for (const [image, select] of [[over, left], [under, right]]) {
        const from = picture(select.value);
        const asked = `${point.value} ${select.value} ${ev}`;
        if (image.dataset.shows === asked) continue;
        image.dataset.shows = asked;
        image.alt = from.alt;
        if (ev === 0) image.src = from.src;
        const pixels = ev === 0 ? null : await radiance(select.value);
        if (image.dataset.shows === asked && ev !== 0) image.src = pixels ? exposed(pixels, base + ev) : from.src;
      }
    };
    const magnify = () => wipe.style.setProperty("--zoom", zoom.value);
    // The zoom's fixed point is under the pointer: there the picture's place is the box's.
    const look = async (event) => {
      const box = wipe.getBoundingClientRect();
      const [x, y] = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
      wipe.style.setProperty("--x", 100 * x + "%");
      wipe.style.setProperty("--y", 100 * y + "%");
      const [truth, ours] = await Promise.all([radiance("reference"), radiance("result")]);
      if (!truth || !ours) return;
      const at = [x * truth.width, y * truth.height].map(Math.floor);
      if (at[0] < 0 || at[1] < 0 || at[0] >= truth.width || at[1] >= truth.height) return;
      const [a, b] = [truth, ours].map((picture) => picture.pixel(...at));
      const sum = (color) => color[0] + color[1] + color[2];
      const off = sum(a) > 0 ? ` (${sum(b) >= sum(a) ? "+" : "−"}${figure(Math.abs(100 * (sum(b) / sum(a) - 1)))} %)` : "";
      values.textContent = `(${at.join(", ")}) reference ${a.map(figure).join(" ")}\nresult ${b.map(figure).join(" ")}${off} W m⁻² sr⁻¹`;
    };
    const drag = (event) => {
      look(event);
      if (event.type === "pointermove" && !event.buttons) return;
      const box = wipe.getBoundingClientRect();
      slider.value = (100 * (event.clientX - box.left)) / box.width;
      update();
    };
    for (const select of [point, left, right]) select.addEventListener("change", update);
    slider.addEventListener("input", update);
    exposure.addEventListener("input", update);
    zoom.addEventListener("change", magnify);
    wipe.addEventListener("pointerdown", drag);
    wipe.addEventListener("pointermove", drag);
    viewer.hidden = false;
    part.querySelector(".gallery").open = false;
    update();
  }

  function makeSortable(table) {
    const heads = [...table.tHead.rows[0].cells];
    heads.slice(0, -1).forEach((head, column) => {
      const button = element('<button type="button"></button>');
      button.textContent = head.textContent;
      head.replaceChildren(button);
      button.addEventListener("click", () => {
        const up = head.getAttribute("aria-sort") !== "ascending";
        for (const other of heads) other.removeAttribute("aria-sort");
        head.setAttribute("aria-sort", up ? "ascending" : "descending");
        const value = (row) => row.cells[column].dataset.value;
        const compare = (a, b) => {
          if (column === 0) return a.cells[0].textContent.localeCompare(b.cells[0].textContent, "en", { numeric: true });
          return value(a) - value(b);
        };
        const rows = [...table.tBodies[0].rows];
        const there = rows.filter((row) => column === 0 || value(row) !== undefined).sort(compare);
        if (!up) there.reverse();
        table.tBodies[0].append(...there, ...rows.filter((row) => !there.includes(row)));  // no figure: last
      });
    });
  }

  function update() {
    const { light } = asked();
    for (const part of parts) {
      part.hidden = part.dataset.light !== light;
      if (!part.hidden) show(part);
    }
  }

  parts.forEach(makeViewer);
  document.querySelectorAll("table.sortable").forEach(makeSortable);
  controls.hidden = false;
  controls.addEventListener("change", update);
  controls.addEventListener("submit", (event) => event.preventDefault());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", update);
  update();
  document.documentElement.dataset.ready = "yes";
})();
