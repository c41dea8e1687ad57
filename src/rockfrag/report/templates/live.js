(() => {
  "use strict";
  const root = document.getElementById("live");
  const find = (name) => root.querySelector("." + name);
  const data = JSON.parse(document.getElementById("live-data").textContent);
  const CHEAP = 60; // amplitudes of a bar that is not of the study's table
  const say = rockfragSayer(data.texts);
  const SIZES = [
    ["width", "width", "cm"],
    ["height", "height", "cm"],
    ["cgHeight", "cg_height", "cm"],
    ["mass", "mass", "kg"],
  ];

  const motions = data.motions.map((one) => ({
    ...one,
    samples: new Float64Array(rockfragBytes(one.samples).buffer),
  }));

  // ---- what is shown: the case, and its response
  let kernel;
  let body;
  let shaking;
  let response;
  let outline;
  const chosen = { body: 0, motion: 0, amplitude: 1, sizes: null, restitution: null };
  let time = 0;
  let playing = false;
  let before = 0;
  let peaks = [];
  let bar = null;

  const original = () => data.bodies[chosen.body];
  const motion = () => motions[chosen.motion];
  const changed = () => chosen.sizes !== null || chosen.restitution !== null;
  const spec = () => chosen.sizes ?? original();
  // the same operations in the same order as a study scales its motions
  const scaleOf = (peak) =>
    peak === motion().pga_g ? 1 : (peak * data.gravity) / motion().pga;

  function integrate(peak, history) {
    return kernel.integrate({
      body,
      samples: motion().samples,
      scale: scaleOf(peak),
      dt: motion().dt,
      ...shaking,
      history,
    });
  }

  function build() {
    const one = spec();
    const { restitution: ratio } = chosen;
    const restitution = one.pedestal && ratio !== null ? [ratio, ratio] : ratio;
    body = kernel.bodyOf({
      statue: one.statue,
      pedestal: one.pedestal ?? undefined,
      offset: one.offset,
      restitution,
      g: data.gravity,
    });
    shaking = kernel.shakingOf(body, motion().dt);
    outline = outlineOf(one);
  }

  function update() {
    try {
      build();
      response = integrate(chosen.amplitude, true);
    } catch (error) {
      response = null;
      find("outcomes").textContent = error.message;
      return;
    }
    peaks = response.contact_events
      .filter((one) => one.kind === "impact")
      .map((one) => one.time);
    time = Math.min(time, duration());
    tell();
    drawHistory();
    drawScene();
  }

  // nothing stands, and nothing moves, with dimensions that cannot be
  const duration = () => (response ? (response.done - 1) * motion().dt : 0);

  // ---- geometry: x to the right, y up, a rotation is clockwise
  const turn = ([x, y], angle) => {
    const c = Math.cos(angle);
    const s = Math.sin(angle);
    return [x * c + y * s, y * c - x * s];
  };
  const add = (a, b) => [a[0] + b[0], a[1] + b[1]];
  const minus = (a, b) => [a[0] - b[0], a[1] - b[1]];
  const corners = (block) =>
    [
      [-1, 0],
      [1, 0],
      [1, 1],
      [-1, 1],
    ].map(([x, y]) => [(x * block.width) / 2, y * block.height]);
  const centreOf = (block) => [block.cgOffset ?? 0, block.cgHeight ?? block.height / 2];

  function outlineOf({ statue, pedestal, offset }) {
    if (!pedestal) return { statue, lean: 0, aside: 0, half: statue.width / 2 };
    const left = Math.max(-pedestal.width / 2, offset - statue.width / 2);
    const right = Math.min(pedestal.width / 2, offset + statue.width / 2);
    const middle = (left + right) / 2;
    return {
      statue,
      pedestal,
      lean: pedestal.lean ?? 0,
      middle,
      half: (right - left) / 2,
      aside: offset - middle,
    };
  }

  // corners and centre of each block at rotations theta1, theta2
  function pose(theta1, theta2) {
    const { statue, pedestal, lean, middle, half, aside } = outline;
    const found = {};
    let foot = [0, 0];
    if (pedestal) {
      const pole = [((theta1 < 0 ? -1 : 1) * pedestal.width) / 2, 0];
      const place = (p) => add(pole, turn(minus(turn(p, lean), pole), theta1));
      found.pedestal = corners(pedestal).map(place);
      found.pedestalCentre = place(centreOf(pedestal));
      const side = theta2 - theta1 < 0 ? -1 : 1;
      foot = [place([middle + side * half, pedestal.height]), [side * half, 0]];
    } else {
      const side = theta2 < 0 ? -1 : 1;
      foot = [
        [side * half, 0],
        [side * half, 0],
      ];
    }
    const own = (q) => turn(add(turn(q, statue.lean ?? 0), [aside, 0]), lean);
    const place = (q) => add(foot[0], turn(minus(own(q), turn(foot[1], lean)), theta2));
    found.statue = corners(statue).map(place);
    found.statueCentre = place(centreOf(statue));
    return found;
  }

  // ---- words
  function contacts(c1, c2) {
    const side = (c) => (c > 0 ? "right" : "left");
    if (c2 === 0 && (!outline.pedestal || c1 === 0)) return say("at_rest");
    if (!outline.pedestal) return say(`rocks_${side(c2)}`);
    if (c1 === 0) return say(`object_${side(c2)}`);
    return say(c2 === 0 ? `whole_${side(c1)}` : `both_${side(c2)}_${side(c1)}`);
  }
  const shown = rockfragDecimals(data.texts.decimal);

  function outcomeOfTable() {
    if (changed()) return null;
    const row = data.outcomes[chosen.body][chosen.motion];
    const place = data.amplitudes.indexOf(chosen.amplitude);
    if (place >= 0) return row[place] === "1";
    return null;
  }
  const words = (fell) =>
    `<strong class="${fell ? "falls" : "stands"}">${say(fell ? "overturns" : "stands")}</strong>`;

  function tell() {
    const fell = response.fallen > 0;
    const table = outcomeOfTable();
    const source = say(data.source);
    const known = changed() ? "changed" : "not_in_table";
    const here = {
      what: words(fell),
      impacts: peaks.length,
      time: fell ? shown(response.fallTime, 2) : "",
    };
    const beside =
      table === null
        ? say(known, { source })
        : say(table === fell ? "table_equal" : "table_differs", {
            source,
            what: words(table),
          });
    // of numbers and fixed words alone
    find("outcomes").innerHTML =
      `${say(fell ? "here_fell" : "here_stood", here)} ${beside}`;
    const peak = shown(chosen.amplitude, 3);
    find("peak").textContent =
      chosen.amplitude === motion().pga_g ? say("as_recorded", { peak }) : `${peak} g`;
  }

  // ---- drawing
  let colours = {};
  // a canvas that is not laid out, as while a page is measured, cannot be copied
  const hasPixels = (canvas) => canvas.width > 0 && canvas.height > 0;
  function polygon(context, points, fill) {
    context.beginPath();
    for (const [x, y] of points) context.lineTo(x, y);
    context.closePath();
    context.fillStyle = fill;
    context.globalAlpha = 0.85;
    context.fill();
    context.globalAlpha = 1;
    context.strokeStyle = colours.ink;
    context.stroke();
  }
  function at(values, k) {
    const low = Math.min(Math.floor(k), response.done - 1);
    const high = Math.min(low + 1, response.done - 1);
    return values[low] + (values[high] - values[low]) * (k - low);
  }
  function drawScene() {
    if (!response) return;
    const [context, width, height] = rockfragSized(find("scene"));
    const k = time / motion().dt;
    const index = Math.min(Math.round(k), response.done - 1);
    const drawn = pose(
      outline.pedestal ? at(response.theta1, k) : 0,
      at(response.theta2, k),
    );
    const tall = outline.statue.height + (outline.pedestal?.height ?? 0);
    const broad = Math.max(outline.statue.width, outline.pedestal?.width ?? 0);
    const floor = height - 34;
    const scale = Math.min((floor - 14) / (1.12 * tall), width / (2.3 * tall + broad));
    motion().moved ??= rockfragDisplacement(motion().samples, motion().dt);
    const moved =
      motion().moved[Math.min(index, motion().moved.length - 1)] *
      scaleOf(chosen.amplitude);
    const shift = Math.max(-0.3, Math.min(0.3, (moved * scale) / width)) * width;
    const screen = ([x, y]) => [width / 2 + shift + x * scale, floor - y * scale];
    // the ground moves with its marks
    context.fillStyle = colours.band;
    context.fillRect(0, floor, width, height - floor);
    context.strokeStyle = colours.rule;
    context.beginPath();
    for (let x = (shift % 24) - 24; x < width + 24; x += 24) {
      context.moveTo(x, floor + 14);
      context.lineTo(x + 10, floor);
    }
    context.moveTo(0, floor);
    context.lineTo(width, floor);
    context.stroke();
    if (drawn.pedestal) polygon(context, drawn.pedestal.map(screen), colours.red);
    polygon(context, drawn.statue.map(screen), colours.blue);
    for (const centre of [drawn.statueCentre, drawn.pedestalCentre]) {
      if (!centre) continue;
      const [x, y] = screen(centre);
      context.beginPath();
      context.arc(x, y, 3, 0, 7);
      context.fillStyle = colours.paper;
      context.fill();
      context.strokeStyle = colours.ink;
      context.stroke();
    }
    const acceleration = (motion().samples[index] ?? 0) * scaleOf(chosen.amplitude);
    arrow(
      context,
      width / 2,
      floor + 24,
      (acceleration / (chosen.amplitude * data.gravity)) * 0.3 * width,
    );
    // a metre to go by
    const length = [1, 0.1].find((each) => tall > LEAST_HEIGHT[each]) ?? 0.01;
    inColour(context, colours.ink);
    context.beginPath();
    context.moveTo(12, 18);
    context.lineTo(12 + length * scale, 18);
    context.stroke();
    context.fillText(length === 1 ? "1 m" : `${length * 100} cm`, 12, 34);
    const strike = peaks.some((one) => Math.abs(one - time) < 0.04);
    if (strike) context.fillText(say("impact"), 12, 54);
    find("state").textContent = happening(index);
    find("clock").textContent = `${shown(time, 2)} s`;
    find("time").value = String(duration() ? time / duration() : 0);
  }
  function happening(index) {
    if (response.fallen > 0 && time >= response.fallTime - 1e-9)
      return say(response.fallen === 1 ? "both_fell" : "fell");
    return contacts(response.c1[index], response.c2[index]);
  }
  // of what lengths, drawn to go by, the body is tall enough [m]
  const LEAST_HEIGHT = { 1: 1.5, 0.1: 0.3 };
  function inColour(context, colour) {
    context.strokeStyle = colour;
    context.fillStyle = colour;
  }
  function arrow(context, x, y, length) {
    inColour(context, colours.accent);
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + length, y);
    context.stroke();
    context.lineWidth = 1;
    const tip = Math.sign(length) * Math.min(7, Math.abs(length));
    context.beginPath();
    context.moveTo(x + length, y);
    context.lineTo(x + length - tip, y - 4);
    context.lineTo(x + length - tip, y + 4);
    context.fill();
  }
  // the history as it stands, drawn once; each frame adds the time to it
  const drawnHistory = document.createElement("canvas");
  function drawHistory() {
    if (!response) return;
    const canvas = find("history");
    const [context, width, height] = rockfragSized(canvas);
    const left = 44;
    const bottom = height - 18;
    const top = 16;
    const middle = top + (bottom - top) * 0.66;
    const end = Math.max(duration(), motion().dt);
    const x = (t) => left + (t / end) * (width - left - 8);
    const single = !outline.pedestal;
    const lines = single
      ? [["theta2", colours.blue, "object"]]
      : [
          ["theta1", colours.red, "pedestal"],
          ["theta2", colours.blue, "object"],
        ];
    let most = 1e-9;
    for (const [name] of lines)
      for (const value of response[name]) most = Math.max(most, Math.abs(value));
    // a fall leaves the picture, so that the rocking before it can be seen
    most = Math.min(most, 1.4 * Math.atan(spec().statue.width / spec().statue.height));
    const half = (middle - top) / 2;
    const y = (value) =>
      top + half - (Math.max(-most, Math.min(most, value)) / most) * half;
    context.strokeStyle = colours.line;
    context.beginPath();
    context.moveTo(left, top + half);
    context.lineTo(width - 8, top + half);
    context.stroke();
    lines.forEach(([name, colour, title], number) => {
      inColour(context, colour);
      context.beginPath();
      const values = response[name];
      const step = Math.max(1, Math.floor(response.done / (4 * width)));
      for (let k = 0; k < response.done; k += step)
        context.lineTo(x(k * motion().dt), y(values[k]));
      context.stroke();
      context.fillText(title, left + 6 + 70 * number, 12);
    });
    context.fillStyle = colours.soft;
    const degrees = `${shown((most * 180) / Math.PI, 1)}°`;
    context.textAlign = "right";
    for (const [text, height] of [
      [degrees, top + 8],
      ["0", top + half + 4],
      ["−" + degrees, middle],
    ])
      context.fillText(text, left - 4, height);
    context.textAlign = "left";
    context.fillText("| impacts", left + 6 + 70 * lines.length, 12);
    context.strokeStyle = colours.ink;
    context.beginPath();
    for (const t of peaks) {
      context.moveTo(x(t), top + half - 4);
      context.lineTo(x(t), top + half + 4);
    }
    context.stroke();
    // the ground's acceleration below
    const base = (middle + bottom) / 2 + 3;
    const reach = (bottom - middle) / 2 - 4;
    const samples = motion().samples;
    context.strokeStyle = colours.rule;
    context.beginPath();
    const step = Math.max(1, Math.floor(samples.length / (6 * width)));
    for (let k = 0; k < Math.min(samples.length, response.done); k += step)
      context.lineTo(x(k * motion().dt), base - (samples[k] / motion().pga) * reach);
    context.stroke();
    context.fillText(say("ground"), 2, base + 4);
    context.fillText("0", left, height - 4);
    context.fillText(`${shown(end, 1)} s`, width - 42, height - 4);
    Object.assign(drawnHistory, { width: canvas.width, height: canvas.height });
    if (hasPixels(canvas)) drawnHistory.getContext("2d").drawImage(canvas, 0, 0);
    drawTime();
    canvas.setAttribute(
      "aria-label",
      say(response.fallen > 0 ? "history_fell" : "history_stood", {
        end: shown(end, 1),
        impacts: peaks.length,
      }),
    );
  }
  function drawTime() {
    if (!response) return;
    const [context, width, height] = rockfragSized(find("history"));
    if (hasPixels(drawnHistory)) context.drawImage(drawnHistory, 0, 0, width, height);
    const x = 44 + (time / Math.max(duration(), motion().dt)) * (width - 52);
    context.strokeStyle = colours.accent;
    rockfragUpright(context, x, 0, height - 18);
  }
  const along = rockfragAlong(data.amplitudes);
  function drawBar() {
    const [context, width, height] = rockfragSized(find("bar"));
    const x = (g) => 4 + along(g) * (width - 8);
    const row = data.outcomes[chosen.body][chosen.motion];
    const lines = [[data.amplitudes, row, changed() ? "table" : ""]];
    if (changed() && bar) lines.push([bar.amplitudes, bar.outcomes, "changed"]);
    const each = (height - 16) / lines.length;
    lines.forEach(([amplitudes, outcomes, title], number) => {
      const edge = (k) =>
        k > 0 && k < amplitudes.length
          ? Math.sqrt(amplitudes[k - 1] * amplitudes[k])
          : amplitudes.at(k && -1);
      for (let k = 0, from = 0; k < outcomes.length; k++) {
        if (outcomes[k + 1] === outcomes[k]) continue;
        context.fillStyle = outcomes[k] === "1" ? colours.red : colours.band;
        context.fillRect(
          x(edge(from)),
          number * each,
          Math.max(x(edge(k + 1)) - x(edge(from)), 1),
          each - 2,
        );
        from = k + 1;
      }
      context.fillStyle = colours.ink;
      context.fillText(title, 6, number * each + Math.min(each - 3, 11));
    });
    rockfragBarScale({ context, width, height, along, colours }, chosen.amplitude);
    const least = shown(data.amplitudes[row.indexOf("1")] ?? 0, 3);
    find("bar").setAttribute("aria-label", rockfragBarLabel(say, row, least));
  }
  // outcomes of changed dimensions over the amplitudes, a few in each idle moment
  let computing = 0;
  function computeBar() {
    const number = ++computing;
    bar = null;
    if (!changed() || !response) return;
    const low = data.amplitudes[0];
    const ratio = data.amplitudes.at(-1) / low;
    const next = {
      amplitudes: Array.from(
        { length: CHEAP },
        (_, k) => low * ratio ** (k / (CHEAP - 1)),
      ),
      outcomes: "",
    };
    const go = () => {
      if (number !== computing) return;
      const until = performance.now() + 8;
      while (next.outcomes.length < CHEAP && performance.now() < until)
        next.outcomes +=
          integrate(next.amplitudes[next.outcomes.length], false).fallen > 0
            ? "1"
            : "0";
      bar = next;
      drawBar();
      if (next.outcomes.length < CHEAP) setTimeout(go, 0);
    };
    go();
  }

  // ---- controls
  function fillSizes() {
    const box = find("sizes");
    box.querySelectorAll("label").forEach((one) => one.remove());
    for (const part of ["statue", "pedestal"]) {
      if (!spec()[part]) continue;
      for (const [key, title, unit] of SIZES) {
        const label = document.createElement("label");
        const input = document.createElement("input");
        const factor = unit === "cm" ? 100 : 1;
        input.type = "number";
        input.step = "any";
        // half the height, where the centre of gravity was not given
        const value = spec()[part][key] ?? spec()[part].height / 2;
        input.value = String(+(value * factor).toPrecision(8));
        input.addEventListener("input", () => {
          const value = Number(input.value) / factor;
          if (!(value > 0)) return;
          resize((sizes) => {
            sizes[part][key] = value;
          });
        });
        const size = say(title);
        const named =
          part === "pedestal" ? say("of_pedestal", { size: size.toLowerCase() }) : size;
        label.append(`${named} [${unit}]`, input);
        box.append(label);
      }
    }
  }
  function resize(change) {
    chosen.sizes ??= structuredClone({
      statue: original().statue,
      pedestal: original().pedestal,
      offset: original().offset,
    });
    change(chosen.sizes);
    update();
    computeBar();
    drawBar();
  }
  function refresh() {
    stop();
    time = 0;
    update();
    computeBar();
    drawBar();
    fillSizes();
    if (response) {
      time = turnedMost();
      drawScene();
      drawTime();
    }
  }
  // the moment of the largest rotation, which a still picture shows best
  function turnedMost() {
    let best = 0;
    for (let k = 0; k < response.done; k++)
      if (Math.abs(response.theta2[k]) > Math.abs(response.theta2[best])) best = k;
    return response.fallen > 0
      ? Math.max(0, response.fallTime - 0.25)
      : best * motion().dt;
  }
  function setPeak(peak) {
    chosen.amplitude = peak;
    let nearest = 0;
    data.amplitudes.forEach((g, k) => {
      if (
        Math.abs(Math.log(g / peak)) <
        Math.abs(Math.log(data.amplitudes[nearest] / peak))
      )
        nearest = k;
    });
    find("amplitude").value = String(nearest);
    find("amplitude").setAttribute("aria-valuetext", `${shown(peak, 3)} g`);
  }
  function stop() {
    playing = false;
    find("play").textContent = say("play");
  }
  function frame(now) {
    if (!playing) return;
    const step = before ? Math.min(now - before, 100) / 1000 : 0;
    before = now;
    root.frames = (root.frames ?? 0) + 1;
    time += step * Number(find("speed").value);
    if (time >= duration()) {
      time = duration();
      stop();
    }
    drawScene();
    drawTime();
    if (playing) requestAnimationFrame(frame);
  }
  // who wants less motion goes from event to event
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  function play() {
    if (playing) return stop();
    if (!response) return;
    if (still.matches) return nextEvent();
    if (time >= duration() - 1e-9 || !find("play").dataset.begun) time = 0;
    find("play").dataset.begun = "1";
    playing = true;
    before = 0;
    find("play").textContent = say("pause");
    requestAnimationFrame(frame);
  }
  function move(to) {
    stop();
    find("play").dataset.begun = "1";
    time = Math.max(0, Math.min(duration(), to));
    drawScene();
    drawTime();
  }
  function nextEvent() {
    const next = response?.contact_events.find((one) => one.time > time + 1e-6);
    if (next) move(next.time);
  }
  function edge(first) {
    const row = data.outcomes[chosen.body][chosen.motion];
    const place = row.indexOf("1");
    const below = Math.max(0, place - 1);
    const last = row.length - 1;
    const beside = first ? place : below;
    setPeak(data.amplitudes[place < 0 ? last : beside]);
    refresh();
  }

  async function begin() {
    kernel = await rockfragKernel(rockfragBytes(data.module));
    root.kernel = kernel;
    colours = rockfragColours();
    for (const [name, list] of [
      ["body", data.bodies],
      ["motion", motions],
    ])
      list.forEach((one, k) => find(name).add(new Option(one.name, k)));
    find("amplitude").max = String(data.amplitudes.length - 1);
    Object.assign(chosen, { body: data.start.body, motion: data.start.motion });
    find("body").value = String(chosen.body);
    find("motion").value = String(chosen.motion);
    setPeak(data.start.amplitude);
    find("body").addEventListener("change", (event) => {
      chosen.body = Number(event.target.value);
      chosen.sizes = null;
      refresh();
    });
    find("motion").addEventListener("change", (event) => {
      chosen.motion = Number(event.target.value);
      refresh();
    });
    find("amplitude").addEventListener("input", (event) => {
      setPeak(data.amplitudes[Number(event.target.value)]);
      update();
      drawBar();
    });
    find("recorded").addEventListener("click", () => {
      setPeak(motion().pga_g);
      refresh();
    });
    find("weaker").addEventListener("click", () => edge(false));
    find("stronger").addEventListener("click", () => edge(true));
    find("wider").addEventListener("click", () => {
      resize((sizes) => {
        sizes.statue.width += 0.05;
      });
      fillSizes();
    });
    find("reset").addEventListener("click", () => {
      chosen.sizes = null;
      chosen.restitution = null;
      find("restitution").value = "";
      refresh();
    });
    find("restitution").parentElement.hidden = !kernel.restitution;
    find("restitution").addEventListener("input", (event) => {
      chosen.restitution =
        event.target.value === "" ? null : Number(event.target.value);
      update();
      computeBar();
      drawBar();
    });
    find("play").addEventListener("click", play);
    find("next").addEventListener("click", nextEvent);
    find("time").addEventListener("input", (event) =>
      move(Number(event.target.value) * duration()),
    );
    find("scene").addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -motion().dt, ArrowRight: motion().dt }[event.key];
      if (step) move(time + step);
      else if (event.key === " ") play();
      else return;
      event.preventDefault();
    });
    find("history").addEventListener("pointerdown", (event) => {
      const box = event.target.getBoundingClientRect();
      move(((event.clientX - box.left - 44) / (box.width - 52)) * duration());
    });
    find("controls").addEventListener("submit", (event) => event.preventDefault());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      colours = rockfragColours();
      redraw();
    });
    if (still.matches) find("play").hidden = true;
    addEventListener("resize", redraw);
    tellHeight();
    find("app").hidden = false;
    find("frames").classList.add("still");
    refresh();
    root.dataset.ready = "1";
  }
  function redraw() {
    drawScene();
    drawHistory();
    drawBar();
  }
  // A page that shows this one in a frame learns how high the frame has to be; it
  // cannot look for itself.
  function tellHeight() {
    if (parent === window) return;
    const tell = () =>
      parent.postMessage(
        { rockfragHeight: document.documentElement.offsetHeight },
        "*",
      );
    new ResizeObserver(tell).observe(document.documentElement);
  }
  begin();
})();
