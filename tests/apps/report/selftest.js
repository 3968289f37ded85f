// Run in the page by page_test.py, as a WebDriver script: uses the page as a reader would and answers what failed.
const answer = arguments[arguments.length - 1];
(async () => {
  const failed = [];
  let checks = 0;
  const check = (holds, text) => { checks += 1; if (!holds) failed.push(text); };
  const pause = () => new Promise((done) => setTimeout(done, 20));
  const event = (target, type, more) => target.dispatchEvent(Object.assign(new Event(type, { bubbles: true }), more));
  const visible = () => [...document.querySelectorAll(".light")].filter((part) => !part.hidden);
  const chartOf = (part) => Chart.getChart(part.querySelector("canvas"));
  const plotted = (part) => chartOf(part).data.datasets.flatMap((set) => set.data).filter((item) => item.point);
  const controls = document.querySelector(".controls").elements;
  let points = 0;

  try {
    await pause();
    check(document.documentElement.dataset.ready === "yes", "the script did not come to its end");
    check(typeof Chart === "function", "no Chart.js in the page");

    for (const light of ["indirect", "full"]) {
      [...controls.light].find((radio) => radio.value === light).click();
      await pause();
      check(visible().length > 0 && visible().every((part) => part.dataset.light === light), `only ${light} light is shown`);
      for (const part of visible()) {
        const rows = part.querySelectorAll("tbody tr:not(.failed)").length;
        check(plotted(part).length === rows, `${light}: ${plotted(part).length} points for ${rows} rows`);
        points += plotted(part).length;
        const pixels = part.querySelector("canvas").getBoundingClientRect();
        check(pixels.width > 200 && pixels.height > 200, `${light}: the plot is ${pixels.width} x ${pixels.height}`);
        const inside = chartOf(part).data.datasets.flatMap((_, d) => chartOf(part).getDatasetMeta(d).data)
          .every((e) => e.x >= 0 && e.x <= pixels.width && e.y >= 0 && e.y <= pixels.height);
        check(inside, `${light}: points lie outside of the plot`);
        check(!part.querySelector(".plot-svg"), `${light}: the still plot is there as well`);
      }
    }
    [...controls.light][0].click();
    await pause();
    const part = visible()[0];
    const chart = chartOf(part);

    const before = plotted(part).map((item) => item.y).join();
    for (const metric of ["blk_pct", "flip", "dssim", "rmse_pct_denoised"]) {
      controls.metric.value = metric;
      event(controls.metric, "change");
      await pause();
      check(chart.options.scales.y.title.text === controls.metric.selectedOptions[0].textContent, `axis of ${metric}`);
      check((plotted(part).map((item) => item.y).join() === before) === (metric === "rmse_pct_denoised"), `values of ${metric}`);
    }
    const front = chart.data.datasets.at(-1).data;
    check(front.length > 0 && front.every((item) =>
      !plotted(part).some((other) => other.x < item.x && other.y < item.y)), "the front has a point that another beats");

    chart.canvas.focus();
    const readout = part.querySelector(".readout");
    const said = new Set();
    for (let i = 0; i < plotted(part).length; ++i) {
      said.add(readout.textContent);
      chart.canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }));
      await pause();
    }
    said.add(readout.textContent);
    check(said.size === plotted(part).length, `arrow keys reach ${said.size} of ${plotted(part).length} points`);
    check([...said].every((text) => / ms .*%/.test(text)), `said: ${[...said].join(" | ")}`);

    const viewer = part.querySelector(".viewer");
    const wipe = viewer.querySelector(".wipe");
    const slider = viewer.querySelector("input[type=range]:not([name])");
    const images = [...viewer.querySelectorAll("img")];
    check(images.every((image) => image.complete && image.naturalWidth === 48), "the viewer's pictures did not load");
    slider.value = 25;
    event(slider, "input");
    check(wipe.style.getPropertyValue("--at") === "25%", "the slider does not move the wipe");
    check(getComputedStyle(images[1].parentElement).clipPath.includes("inset"), "the upper picture is not cut");
    const area = wipe.getBoundingClientRect();
    check(area.width > 100 && Math.abs(area.width - area.height) < 2, `the viewer is ${area.width} x ${area.height}`);
    wipe.dispatchEvent(new PointerEvent("pointerdown", { bubbles: true, clientX: area.left + 0.75 * area.width, buttons: 1 }));
    check(Math.abs(slider.value - 75) <= 1, `dragging to 75 % gives ${slider.value}`);
    const pixels = (image) => {
      const canvas = Object.assign(document.createElement("canvas"), { width: 48, height: 48 });
      canvas.getContext("2d").drawImage(image, 0, 0);
      return canvas.getContext("2d").getImageData(0, 0, 48, 48).data;
    };
    const mean = (bytes) => bytes.reduce((sum, byte, i) => sum + (i % 4 < 3 ? byte : 0), 0) / (bytes.length * 0.75);
    const exposure = viewer.querySelector("input[name=exposure]");
    const shown = async (ev) => {
      exposure.value = ev;
      event(exposure, "input");
      for (let i = 0; i < 10; ++i) await pause();
      await images[0].decode();
      return mean(pixels(images[0]));
    };
    const [plain, brighter, darker, again] = [await shown(0), await shown(1), await shown(-1), await shown(0)];
    exposure.step = "any";
    const drawn = await shown(1e-6);  // by the script, of the radiance
    check(Math.abs(drawn - plain) < 1, `the script's tone map: mean ${drawn}, not ${plain}`);
    await shown(0);
    check(brighter > 1.15 * plain && darker < 0.9 * plain && again === plain, `exposure: means ${[darker, plain, brighter, again]}`);
    wipe.dispatchEvent(new PointerEvent("pointermove", { bubbles: true, clientX: area.left + 0.5 * area.width, clientY: area.top + 0.5 * area.height }));
    for (let i = 0; i < 10; ++i) await pause();
    const said_values = viewer.querySelector(".values").textContent;
    check(/^\(24, 24\) reference [\d.]+ [\d.]+ [\d.]+\nresult [\d.]+ .*%\) W/.test(said_values), `under the pointer: ${said_values}`);
    const [point, , right, zoom] = viewer.querySelectorAll("select");
    zoom.value = "4";
    event(zoom, "change");
    check(images.every((image) => getComputedStyle(image).transform.startsWith("matrix(4, 0, 0, 4")), "no zoom");
    const source = images[0].src;
    right.value = "error";
    event(right, "change");
    check(images[0].src !== source && images[0].src.startsWith("data:"), "no error map");
    const map = images[0].src;
    point.selectedIndex = (point.selectedIndex + 1) % point.options.length;
    event(point, "change");
    check(images[0].src !== map, "another point has the same picture");

    const table = part.querySelector("table.sortable");
    const times = () => [...table.tBodies[0].rows].map((row) => Number(row.cells[1].dataset.value)).filter(Number.isFinite);
    const button = table.tHead.querySelectorAll("button")[1];
    for (const sign of [1, -1]) {
      button.click();
      check(times().every((t, i, all) => i === 0 || sign * (t - all[i - 1]) >= 0), "the table is not sorted");
      check(button.parentElement.getAttribute("aria-sort") === (sign > 0 ? "ascending" : "descending"), "aria-sort");
    }
    for (const reachable of [slider, point, button, chart.canvas, controls.metric]) {
      reachable.focus();
      check(document.activeElement === reachable, `the keyboard does not reach ${reachable.tagName}`);
    }
  } catch (error) {
    failed.push(String(error.stack));
  }
  const background = getComputedStyle(document.body).backgroundColor;
  const dark = background.match(/\d+/g).slice(0, 3).every((channel) => channel < 100);
  answer({ failed, checks, points, dark, background, width: document.documentElement.scrollWidth });
})();
