(() => {
  "use strict";
  const root = document.getElementById("live");
  const find = (name) => root.querySelector("." + name);
  const data = JSON.parse(document.getElementById("live-data").textContent);
  const say = rockfragSayer(data.texts);
  const SIZES = [
    ["width", "width", "cm"],
    ["depth", "depth", "cm"],
    ["height", "height", "cm"],
    ["cgHeight", "cg_height", "cm"],
    ["mass", "mass", "kg"],
  ];
  const numbers = (text) => new Float64Array(rockfragBytes(text).buffer);
  const motions = data.motions.map((one) => ({
    ...one,
    samples: one.samples.map(numbers),
  }));
  const shown = rockfragDecimals(data.texts.decimal);
  const degrees = (angle) => `${shown((angle * 180) / Math.PI, 1)}°`;

  // ---- what is shown: the case, and its response
  let space;
  let view;
  let solid;
  let response;
  let colours = {};
  const chosen = { body: 0, motion: 0, place: 0, peak: 0, sizes: null };
  let time = 0;
  let playing = false;
  let before = 0;
  let bar = "";
  let computing = 0;
  const motion = () => motions[chosen.motion];
  const given = () => data.bodies[chosen.body];
  const scaleOf = (peak) => (peak === motion().peak_g ? 1 : peak / motion().peak_g);
  const duration = () => Math.max(0, response.done - 1) * motion().dt;
  const row = (k) =>
    response.history.subarray(k * space.columns, (k + 1) * space.columns);

  function shake(peak, history) {
    const [x, y = null, z = null] = motion().samples;
    return space.integrate({
      body: solid,
      x,
      y,
      z,
      dt: motion().dt,
      scale: scaleOf(peak),
      history,
    });
  }
  // a body of changed sizes is uniform
  function build() {
    const { sizes } = chosen;
    const own = given();
    solid = space.bodyOf(sizes ? rockfragSolid(sizes) : own.solid);
    solid.tall = sizes?.height ?? own.height;
    solid.round = own.round;
  }
  function update() {
    try {
      build();
      response = shake(chosen.peak, true);
    } catch (error) {
      response = null;
      find("state").textContent = error.message;
      return;
    }
    const peak = shown(chosen.peak, 3);
    find("peak").textContent =
      chosen.peak === motion().peak_g ? say("as_recorded", { peak }) : `${peak} g`;
    time = Math.min(time, duration());
    find("state").textContent = said();
    redraw();
  }
  function said() {
    const { overturned, certainTime, fallDirection, peakTilt, turn, walk } = response;
    if (overturned) {
      const over = (((fallDirection * 180) / Math.PI + 360) % 360).toFixed(0);
      return say("falls_space", { time: shown(certainTime, 2), over });
    }
    if (!(peakTilt > 0)) return say("rests_space");
    return say("stands_space", {
      tilt: degrees(peakTilt),
      turn: degrees(turn),
      walk: shown(100 * Math.hypot(...walk), 1),
    });
  }

  // ---- drawing
  function drawScene() {
    if (!response) return;
    const [context, width, height] = rockfragSized(find("scene"));
    const index = Math.min(Math.round(time / motion().dt), response.done - 1);
    const [x, y, z, ...rest] = row(index);
    motion().moved ??= motion()
      .samples.slice(0, 2)
      .map((own) => rockfragDisplacement(own, motion().dt));
    const most = 0.3 * solid.tall;
    const scale = scaleOf(chosen.peak);
    const ground = [0, 1].map((k) => {
      const moved = motion().moved[k];
      return moved
        ? Math.max(
            -most,
            Math.min(most, scale * moved[Math.min(index, moved.length - 1)]),
          )
        : 0;
    });
    const trace = [];
    for (let k = 0; k <= index; k += 4) trace.push(footOf(row(k)));
    const step = view.paint(
      context,
      width,
      height,
      {
        points: solid.points,
        tall: solid.tall,
        over: solid.height,
        round: solid.round,
        place: [x, y, z],
        attitude: rest.slice(0, 4),
        ground,
        pedestal: given().pedestal,
        trace,
      },
      colours,
    );
    context.fillStyle = colours.soft;
    context.fillText(
      say("square", { size: step < 1 ? `${100 * step} cm` : `${step} m` }),
      10,
      height - 10,
    );
    find("clock").textContent = `${shown(time, 2)} s`;
    find("time").value = String(duration() ? time / duration() : 0);
  }
  const axisOf = ([, , , w, x, y, z]) => [
    2 * (x * z + w * y),
    2 * (y * z - w * x),
    1 - 2 * (x * x + y * y),
  ];
  const footOf = (state) =>
    axisOf(state)
      .slice(0, 2)
      .map((part, k) => state[k] - solid.height * part);
  // tilt over time, and beside it the path of the axis seen from above
  function drawHistory() {
    if (!response) return;
    const [context, width, height] = rockfragSized(find("history"));
    const plan = Math.min(height, 0.3 * width);
    const left = 44;
    const right = width - plan - 14;
    const axes = Array.from({ length: response.done }, (_, k) => axisOf(row(k)));
    const tilts = axes.map(([x, y, z]) => Math.atan2(Math.hypot(x, y), z));
    const most = Math.max(...tilts, 1e-6);
    const end = Math.max(duration(), motion().dt);
    const bottom = height - 20;
    const at = (k) => [
      left + ((k * motion().dt) / end) * (right - left),
      bottom - (tilts[k] / most) * (bottom - 16),
    ];
    const step = Math.max(1, Math.floor(response.done / (3 * width)));
    context.strokeStyle = colours.line;
    context.strokeRect(left, 16, right - left, bottom - 16);
    const middle = [width - plan / 2 - 4, height / 2];
    const far = (0.46 * plan) / Math.sin(Math.min(most, 1.5));
    context.beginPath();
    context.moveTo(middle[0] - plan / 2, middle[1]);
    context.lineTo(middle[0] + plan / 2, middle[1]);
    context.moveTo(middle[0], middle[1] - plan / 2);
    context.lineTo(middle[0], middle[1] + plan / 2);
    context.stroke();
    context.strokeStyle = colours.blue;
    for (const place of [
      at,
      (k) => [middle[0] + far * axes[k][0], middle[1] - far * axes[k][1]],
    ]) {
      context.beginPath();
      for (let k = 0; k < response.done; k += step) context.lineTo(...place(k));
      context.stroke();
    }
    const now = Math.min(Math.round(time / motion().dt), response.done - 1);
    context.strokeStyle = colours.accent;
    rockfragUpright(context, at(now)[0], 8, bottom);
    context.beginPath();
    context.arc(
      middle[0] + far * axes[now][0],
      middle[1] - far * axes[now][1],
      3,
      0,
      7,
    );
    context.stroke();
    context.fillStyle = colours.soft;
    context.fillText("tilt", left + 4, 12);
    context.fillText(say("axis"), width - plan - 4, 12);
    context.textAlign = "right";
    context.fillText(degrees(most), left - 4, 24);
    context.fillText("0", left - 4, bottom);
    context.fillText(`${shown(end, 1)} s`, right, height - 6);
    context.textAlign = "left";
  }
  const along = rockfragAlong(data.amplitudes);
  function drawBar() {
    const [context, width, height] = rockfragSized(find("bar"));
    const x = (peak) => 4 + along(peak) * (width - 8);
    const { amplitudes } = data;
    [...bar].forEach((fell, k) => {
      const [from, to] = [k - 0.5, k + 0.5].map(
        (at) =>
          amplitudes[0] *
          (amplitudes[1] / amplitudes[0]) **
            Math.max(0, Math.min(amplitudes.length - 1, at)),
      );
      context.fillStyle = fell === "1" ? colours.red : colours.band;
      context.fillRect(x(from), 0, x(to) - x(from) + 1, height - 16);
    });
    rockfragBarScale({ context, width, height, along, colours }, chosen.peak);
    const least = shown(data.amplitudes[bar.indexOf("1")] ?? 0, 3);
    find("bar").setAttribute("aria-label", rockfragBarLabel(say, bar, least));
  }
  function redraw() {
    drawScene();
    drawHistory();
    drawBar();
  }
  // outcomes over the amplitudes, a few in each idle moment
  function computeBar() {
    const own = ++computing;
    bar = "";
    const go = () => {
      if (own !== computing || !response) return;
      const until = performance.now() + 12;
      while (bar.length < data.amplitudes.length && performance.now() < until)
        bar += shake(data.amplitudes[bar.length], false).overturned ? "1" : "0";
      drawBar();
      if (bar.length < data.amplitudes.length) setTimeout(go, 0);
      else root.dataset.bar = bar;
    };
    delete root.dataset.bar;
    setTimeout(go, 0);
  }

  // ---- controls
  function fillSizes() {
    const box = find("sizes");
    const own = given();
    box.querySelectorAll("label").forEach((one) => one.remove());
    box.hidden = !own.sizes;
    find("wider").hidden = !own.sizes;
    for (const [key, title, unit] of own.sizes ? SIZES : []) {
      if (own.round && key === "depth") continue;
      const label = document.createElement("label");
      const input = document.createElement("input");
      const factor = unit === "cm" ? 100 : 1;
      Object.assign(input, {
        type: "number",
        step: "any",
        value: String(+((chosen.sizes ?? own.sizes)[key] * factor).toPrecision(6)),
      });
      input.addEventListener("input", () => {
        if (Number(input.value) > 0) resize(key, Number(input.value) / factor);
      });
      label.append(
        `${say(own.round && key === "width" ? "diameter" : title)} [${unit}]`,
        input,
      );
      box.append(label);
    }
  }
  function resize(key, value) {
    chosen.sizes = { ...(chosen.sizes ?? given().sizes), [key]: value };
    update();
    computeBar();
  }
  function refresh() {
    stop();
    time = 0;
    update();
    computeBar();
    fillSizes();
    if (!response) return;
    // the moment of the largest tilt, which a still picture shows best
    let most = 0;
    let tilt = -1;
    for (let k = 0; k < response.done; k++) {
      const z = -axisOf(row(k))[2];
      if (z > tilt) [most, tilt] = [k, z];
    }
    time = most * motion().dt;
    redraw();
  }
  function setPeak(peak) {
    chosen.peak = peak;
    find("amplitude").value = String(
      Math.round(along(peak) * (data.amplitudes.length - 1)),
    );
    find("amplitude").setAttribute("aria-valuetext", `${shown(peak, 3)} g`);
  }
  function edge(first) {
    const at = bar.indexOf("1");
    const last = data.amplitudes.length - 1;
    const beside = first ? at : Math.max(0, at - 1);
    setPeak(data.amplitudes[at < 0 ? last : beside]);
    refresh();
  }
  function stop() {
    playing = false;
    find("play").textContent = say("play");
  }
  function frame(now) {
    if (!playing) return;
    time +=
      (before ? Math.min(now - before, 100) / 1000 : 0) * Number(find("speed").value);
    before = now;
    if (time >= duration()) {
      time = duration();
      stop();
    }
    drawScene();
    drawHistory();
    if (playing) requestAnimationFrame(frame);
  }
  // who wants less motion moves time by hand
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  function play() {
    if (playing || !response || still.matches) return stop();
    if (time >= duration() - 1e-9 || !find("play").dataset.begun) time = 0;
    find("play").dataset.begun = "1";
    playing = true;
    before = 0;
    find("play").textContent = say("pause");
    requestAnimationFrame(frame);
  }
  async function begin() {
    space = await rockfragSpace(await rockfragUnpacked(rockfragBytes(data.module)));
    root.space = space;
    colours = rockfragColours();
    view = rockfragView(find("scene"), drawScene);
    for (const [name, list] of [
      ["body", data.bodies],
      ["motion", motions],
    ])
      list.forEach((one, k) => find(name).add(new Option(one.name, k)));
    find("amplitude").max = String(data.amplitudes.length - 1);
    setPeak(motions[0].peak_g);
    for (const name of ["body", "motion"])
      find(name).addEventListener("change", (event) => {
        chosen[name] = Number(event.target.value);
        if (name === "body") chosen.sizes = null;
        refresh();
      });
    find("amplitude").addEventListener("input", (event) => {
      setPeak(data.amplitudes[Number(event.target.value)]);
      update();
    });
    find("recorded").addEventListener("click", () => {
      setPeak(motion().peak_g);
      refresh();
    });
    find("weaker").addEventListener("click", () => edge(false));
    find("stronger").addEventListener("click", () => edge(true));
    find("wider").addEventListener("click", () => {
      resize("width", (chosen.sizes ?? given().sizes).width + 0.05);
      fillSizes();
    });
    find("reset").addEventListener("click", () => {
      chosen.sizes = null;
      refresh();
    });
    find("play").addEventListener("click", play);
    find("time").addEventListener("input", (event) => {
      stop();
      find("play").dataset.begun = "1";
      time = Number(event.target.value) * duration();
      drawScene();
      drawHistory();
    });
    find("scene").addEventListener("keydown", (event) => {
      if (event.key !== " ") return;
      play();
      event.preventDefault();
    });
    find("controls").addEventListener("submit", (event) => event.preventDefault());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      colours = rockfragColours();
      redraw();
    });
    if (still.matches) find("play").hidden = true;
    addEventListener("resize", redraw);
    find("app").hidden = false;
    refresh();
    root.dataset.ready = "1";
  }
  begin().catch((error) => {
    root.querySelector("p").textContent = say("cannot_run", { why: error.message });
  });
})();
