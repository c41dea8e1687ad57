/* The page: a form, workers that compute beside it, and what they say. */
(() => {
  "use strict";
  const find = (id) => document.getElementById(id);
  const data = JSON.parse(find("data").textContent);
  const make = (tag, attributes = {}, ...children) => {
    const element = Object.assign(document.createElement(tag), attributes);
    element.append(...children);
    return element;
  };
  // a text whose numbers stay on a line with their units, and options with what they say
  const UNITS = data.units.said.join("|");
  const TOGETHER = new RegExp(`(\\d (?:${UNITS})(?![\\p{L}\\d/])|--\\S+ \\S+)`, "u");
  const bound = (text) =>
    text
      .split(TOGETHER)
      .map((part, i) =>
        i % 2 ? make("span", { className: "together", textContent: part }) : part,
      );
  const FIELDS = Object.fromEntries(
    data.groups.map((group) => [
      group,
      data.fields.filter((field) => field.group === group),
    ]),
  );
  if (data.own?.whole)
    FIELDS.place = FIELDS.place.filter(({ name }) => name === "floor");
  // without a kind of standing that an extension has added there is none to choose
  const KINDS = Object.keys(data.kinds);
  if (!KINDS.length) FIELDS.more = FIELDS.more.filter(({ name }) => name !== "stands");
  // groups that open where they are wanted
  const CLOSED = ["more", "pedestal", "place"];
  const ALL = Object.values(FIELDS).flat();
  const PART = 25; // motions of a task
  // why a body cannot stand, in the words of the module
  const FAULTS = Object.fromEntries(
    ROCKFRAG_FAULTS.map((text, i) => [`fault_${i}`, text]),
  );
  let texts = data.texts.en;
  let say = null;
  let speak = null;

  // ---- texts

  function choose(language) {
    texts = { ...FAULTS, ...data.texts.en, ...data.texts[language] };
    document.documentElement.lang = language;
    speak = catalogue(texts);
    say = (id, values = {}) => speak.say({ id, values });
    document.title = say("title");
    for (const element of document.querySelectorAll("[data-text]"))
      element.textContent = say(element.dataset.text);
    find("lead").textContent = say("lead", { motions: data.motions });
    find("made").hidden = !data.made;
    find("made").textContent = say("made");
    find("progress").setAttribute("aria-label", say("answer"));
  }

  // a number of so many digits as the language writes it
  const local = (value, digits) =>
    new Intl.NumberFormat(document.documentElement.lang, {
      maximumSignificantDigits: digits,
    }).format(value);

  // ---- the form

  const form = find("form");
  const inputs = {};
  function drawForm() {
    const old = formTexts();
    form.replaceChildren();
    for (const [group, fields] of Object.entries(FIELDS)) {
      const title = say(group);
      const boxes = fields.map((each) => field(each, old));
      const given = fields.some(
        ({ name }) =>
          inputs[name].checked || (inputs[name].type === "text" && inputs[name].value),
      );
      form.append(
        CLOSED.includes(group)
          ? make(
              "details",
              { open: given },
              make("summary", { textContent: title }),
              ...boxes,
            )
          : make("fieldset", {}, make("legend", { textContent: title }), ...boxes),
      );
    }
  }
  function field({ name, kind, options }, old) {
    const value = old?.[name] ?? data.form[name] ?? "";
    const input =
      {
        lines: () => make("textarea", { rows: 3, value }),
        choice: () =>
          make(
            "select",
            {},
            ...options.map((id) =>
              make("option", { value: id, textContent: say(id || `${name}_usual`) }),
            ),
          ),
        flag: () => make("input", { type: "checkbox", checked: Boolean(value) }),
      }[kind]?.() ?? make("input", { type: "text", value, maxLength: 80 });
    if (name === "floor") input.placeholder = "2/4";
    if (kind === "choice") input.value = options.includes(value) ? value : options[0];
    input.id = `field-${name}`;
    input.setAttribute("aria-describedby", `${input.id}-error`);
    input.addEventListener("input", later);
    inputs[name] = input;
    const label = make("label", { htmlFor: input.id, textContent: say(name) });
    return make(
      "div",
      { className: kind === "lines" ? "field long" : "field" },
      label,
      input,
      make("small", { id: `${input.id}-error` }),
    );
  }
  function formTexts() {
    if (!inputs.width) return null;
    return Object.fromEntries(
      ALL.map(({ name, kind }) => [
        name,
        kind === "flag" ? inputs[name].checked : inputs[name].value,
      ]),
    );
  }
  const whyOf = ({ id, values }) =>
    say(texts[`${id}_refused`] ? `${id}_refused` : id, values);
  function complain(refusal) {
    for (const { name } of ALL) {
      const wrong = refusal?.field === name;
      inputs[name].setAttribute("aria-invalid", String(wrong));
      const { id, values } = refusal ?? {};
      if (wrong && inputs[name].closest("details"))
        inputs[name].closest("details").open = true;
      find(`field-${name}-error`).textContent = wrong ? whyOf({ id, values }) : "";
    }
  }

  // ---- workers

  const pool = [];
  const waiting = [];
  const asked = new Map();
  let number = 0;
  let current = null;
  let other = null;
  async function startWorkers() {
    const url = URL.createObjectURL(
      new Blob([find("computing").textContent], { type: "text/javascript" }),
    );
    const count = Math.max(1, Math.min(4, navigator.hardwareConcurrency ?? 2));
    const modules = {
      fused: rockfragBytes(data.modules.fused),
      plain: rockfragBytes(data.modules.plain),
      space: rockfragBytes(data.modules.space),
      plane: rockfragBytes(data.modules.plane),
      core: rockfragBytes(data.modules.core),
    };
    const samples = rockfragBytes(data.packed);
    const { packed, modules: _, ...rest } = data;
    return Promise.all(
      Array.from({ length: count }, () => {
        const worker = { post: started(url), busy: true };
        worker.post.onmessage = ({ data: message }) => {
          worker.busy = false;
          const task = worker.task;
          worker.task = null;
          next();
          task?.done(message);
        };
        // it could not start at all
        worker.post.onerror = () => worker.task?.done({ failure: "no_workers" });
        pool.push(worker);
        return new Promise((resolve, reject) => {
          worker.task = {
            done: (message) =>
              message.failure ? reject(new Error(message.failure)) : resolve(),
          };
          worker.post.postMessage({ kind: "begin", data: rest, modules, samples });
        });
      }),
    );
  }
  function started(url) {
    try {
      return new Worker(url);
    } catch {
      throw new Error("no_workers");
    }
  }
  // a free worker takes what waits of its own motions, whose floors and tables it has,
  // else what waits first; what an older request asked for is dropped
  function next() {
    for (const [i, worker] of pool.entries()) {
      if (worker.busy) continue;
      for (let k = waiting.length - 1; k >= 0; k--)
        if (waiting[k].of && waiting[k].of !== current && waiting[k].of !== other)
          waiting.splice(k, 1);
      const own = waiting.findIndex(
        ({ message: { first = i * PART } }) =>
          Math.floor(first / PART) % pool.length === i,
      );
      const [task] = waiting.splice(Math.max(own, 0), 1);
      if (!task) return;
      worker.busy = true;
      worker.task = task;
      worker.post.postMessage(task.message);
    }
  }
  function ask(of, message, first = false) {
    return new Promise((resolve) => {
      waiting[first ? "unshift" : "push"]({
        of,
        message,
        done: (result) => {
          if (!of || of === current || of === other) resolve(result);
        },
      });
      next();
    });
  }
  // ---- a request, from its plan to its answer

  let timer = 0;
  let settle = () => {}; // gets why an answer is refused, null once it is complete
  function later() {
    clearTimeout(timer);
    timer = setTimeout(update, 120);
  }
  function update() {
    // it is still starting
    if (!bodies) return;
    const form = formTexts();
    let request;
    try {
      request = bodies.requestOf(form);
    } catch (error) {
      if (!error.field) throw error;
      return refuse(error);
    }
    complain(null);
    find("blocked").hidden = true;
    find("state").hidden = false;
    if (!shown) headline("…");
    for (const place of COMPUTED) find(place).classList.add("stale");
    number += 1;
    // the first answer is timed since the file was opened
    current = {
      id: number,
      request,
      form,
      since: number > 1 ? performance.now() : 0,
    };
    document.body.dataset.stage = "";
    other = null;
    compute(current, (answer) => {
      show(answer);
      if (!answer.last) return;
      slide();
      settle(null);
    });
  }
  const startsOf = (count) =>
    Array.from({ length: Math.ceil(count / PART) }, (_, i) => i * PART);
  async function compute(run, report) {
    const { id, request } = run;
    const count = data.earthquakes.length;
    const plan = await ask(run, { kind: "plan", id, request });
    if (plan.refusal) {
      const refusal = {
        field: plan.refusal.field,
        id: plan.refusal.text,
        values: plan.refusal.values,
      };
      return run === current && refuse(refusal);
    }
    if (plan.failure) return fail(plan.failure);
    const { roles } = plan.result;
    const parts = roles.map(() => []);
    const starts = startsOf(count);
    const needed = (role) =>
      roles.map(({ role: own }, i) => (own === role ? i : -1)).filter((i) => i >= 0);
    const early = needed("first");
    const all = [[0], [...needed("now"), ...needed("moved")], roles.map((_, i) => i)];
    const moments = [...(early.length ? [early] : []), ...all];
    let done = 0;
    let latest = 0;
    let earlier = null;
    const ready = (i) => parts[i].length === starts.length;
    const answerNow = async () => {
      const stage = moments.findLastIndex((all) => all.every(ready));
      if (stage < latest) return;
      latest = stage + 1;
      const message = {
        kind: "answer",
        id,
        request,
        earlier,
        parts: parts.map((each, i) =>
          ready(i) && moments[stage].includes(i) ? each : null,
        ),
      };
      const found = await ask(run, message, true);
      if (found.failure) return fail(found.failure);
      earlier = found.result;
      // a later one was asked for since, and may have come first
      if (stage + 1 < latest) return;
      report({
        run,
        found: found.result,
        early: moments[stage] === early,
        last: stage === moments.length - 1,
      });
    };
    for (const i of new Set([...early, ...roles.keys()]))
      starts.forEach((first) => {
        const message = {
          kind: "count",
          id,
          request,
          run: i,
          first,
          last: Math.min(first + PART, count),
        };
        ask(run, message).then((part) => {
          if (part.failure) return fail(part.failure);
          parts[i].push({ first, ...part.result });
          done += 1;
          if (run === current) progress(done, roles.length * starts.length);
          if (ready(i)) answerNow();
        });
      });
  }
  function refuse(refusal) {
    complain(refusal);
    withdraw(`${say(refusal.field)}: ${whyOf(refusal)}`);
    settle(refusal);
  }
  function fail(why) {
    find("blocked").textContent = say("failed", { why });
    find("blocked").hidden = false;
    withdraw("…");
    settle({ id: "failed", values: { why } });
  }
  // what follows an answer, and is computed after it
  const COMPUTED = ["drawing", "helping"];
  // nothing of an earlier answer stands beside an entry that cannot be used
  function withdraw(words) {
    current = null;
    other = null;
    shown = null;
    scene.of = null;
    if (scene.timer) play();
    headline(words);
    for (const id of ["screen", "state", "behind", ...COMPUTED]) find(id).hidden = true;
    find("done").textContent = "";
    find("keep").disabled = true;
    document.body.dataset.stage = "refused";
  }
  function headline(words) {
    for (const place of ["headline", "bar"])
      find(place).replaceChildren(...bound(words));
  }
  function progress(done, all) {
    find("progress").max = all;
    find("progress").value = done;
    find("done").textContent = say("working", { done, all });
  }

  // ---- the answer

  let shown = null;
  function show(answer) {
    shown = answer;
    const {
      run: { since },
      found,
    } = answer;
    const said = saidOf(found, answer);
    for (const place of ["screen", "state", "behind"]) find(place).hidden = false;
    headline(said.headline);
    find("screen").replaceChildren(...bound(said.screen));
    find("lines").replaceChildren(...linesAs(said));
    if (answer.last) find("done").textContent = say("ready");
    const stage = stageOf(answer);
    const { dataset } = document.body;
    if (stage !== dataset.stage) dataset[stage] = String(performance.now() - since);
    dataset.stage = stage;
    find("keep").disabled = !answer.last;
    document.dispatchEvent(
      new CustomEvent("answer", { detail: { found, last: answer.last } }),
    );
    if (!answer.early && scene.of !== answer.run) scene.drawn = draw(answer);
  }
  function stageOf({ last, found }) {
    if (last) return "complete";
    return found.complete ? "interval" : "first";
  }
  // the first screen and what stands behind it in words; of an answer that is not
  // complete what is known of it
  function saidOf(found, { last = true, early = false } = {}) {
    const {
      first: [likely, ...others],
      details,
    } = found.said;
    const hidden = [
      ...(last ? [] : ["title_helps"]),
      ...(early ? ["title_years"] : []),
    ];
    const lines = details
      .filter(([{ id }]) => !hidden.includes(id))
      .map(([title, said]) => [speak.sentence(title), speak.paragraph(said)]);
    return {
      headline: speak.sentence(likely).replace(/\.$/, ""),
      screen: speak.paragraph(others),
      lines,
    };
  }
  function linesAs({ lines }) {
    return lines.flatMap(([title, text]) => [
      make("dt", { textContent: title }),
      make("dd", {}, ...bound(text)),
    ]);
  }
  // what was typed, in a line
  function typedIn(form) {
    const plain = ALL.filter(
      ({ name, kind }) =>
        (form[name] === true || form[name]?.trim?.()) &&
        !["choice", "lines"].includes(kind) &&
        name !== "level",
    );
    const typed = plain.map(({ name }) =>
      form[name] === true ? say(name) : `${say(name)}: ${form[name]}`,
    );
    if (form.stands) typed.push(say(form.stands));
    if (form.level.trim()) typed.push(`${form.measure}: ${form.level}`);
    if (form.hazard.trim())
      typed.push(
        say("curve_of", {
          measure: form.measure,
          count: form.hazard.trim().split("\n").length,
        }),
      );
    return typed.join("; ") + ".";
  }

  // ---- what helps: sliders, before and after

  const SLIDERS = {
    width: [0, 50, 0],
    cg: [0, 40, 0],
    ballast: [0, 100, 0],
  };
  // distances of a wall behind the object [m], by the number of them in centimetres
  const WALLS = { 0: 0, 2: 0.02, 5: 0.05, 10: 0.1, 20: 0.2 };
  // what it stands at, and what may hold it there
  const THERE = ["", ...Object.keys(WALLS), "casters"];
  const HOLDS = [
    "",
    "putty",
    "bracket",
    "cord",
    "isolator",
    "springs",
    "off_wall",
    "locked",
  ];
  function drawSliders() {
    const chosen = Object.fromEntries(
      ["fixed", "there", "hold", "bears"].map((id) => [
        id,
        find(`slide-${id}`)?.value,
      ]),
    );
    find("sliders").replaceChildren(
      ...Object.entries(SLIDERS).map(([id, [low, high, at]]) => {
        const input = make("input", {
          type: "range",
          min: low,
          max: high,
          step: 1,
          id: `slide-${id}`,
        });
        const output = make("output");
        input.value = at;
        const tell = () => {
          output.textContent = ` ${SLIDERS[id][2]} %`;
        };
        input.addEventListener("input", () => {
          SLIDERS[id][2] = Number(input.value);
          tell();
          slide();
        });
        tell();
        return make(
          "div",
          { className: "field" },
          make("label", { htmlFor: input.id }, say(`slide_${id}`), output),
          input,
        );
      }),
    );
    const whereOf = (at) => {
      if (at === "casters") return say("there_casters");
      return at ? say("there_wall", { distance: at }) : say("there_free");
    };
    const heldBy = (kind) => say(kind ? `held_by_${kind}` : "held_by_nothing");
    find("sliders").append(
      choiceOf("fixed", ["not_fixed", "to_pedestal", "to_floor"], say),
      choiceOf("there", THERE, whereOf),
      choiceOf("hold", HOLDS, heldBy),
      bearsField(),
    );
    for (const [id, value] of Object.entries(chosen))
      if (value) find(`slide-${id}`).value = value;
  }
  function choiceOf(id, values, textOf) {
    const options = values.map((value) =>
      make("option", { value, textContent: textOf(value) }),
    );
    const choice = make("select", { id: `slide-${id}` }, ...options);
    choice.addEventListener("input", slide);
    const label = make("label", { htmlFor: choice.id }, say(`slide_${id}`));
    return make("div", { className: "field" }, label, choice);
  }
  // how much a holder bears; as much as the motions ask where nothing stands
  function bearsField() {
    const input = make("input", {
      type: "text",
      inputMode: "decimal",
      maxLength: 20,
      id: "slide-bears",
    });
    input.setAttribute("aria-describedby", "slide-bears-error");
    let timer = 0;
    input.addEventListener("input", () => {
      clearTimeout(timer);
      timer = setTimeout(slide, 400);
    });
    const label = make("label", { htmlFor: input.id, id: "slide-bears-label" });
    const error = make("small", { id: "slide-bears-error" });
    return make("div", { className: "field", hidden: true }, label, input, error);
  }
  // what is chosen to hold it, and where it stands; null if nothing is
  function holdChosen() {
    const [there, hold] = ["there", "hold"].map((id) => find(`slide-${id}`));
    const atWall = there.value in WALLS;
    const possible = { off_wall: atWall, locked: there.value === "casters" };
    for (const option of hold.options)
      option.hidden = option.disabled = possible[option.value] === false;
    if (hold.selectedOptions[0]?.disabled) hold.value = "";
    const { demand, factor } = data.holding.kinds[hold.value] ?? {};
    const bears = find("slide-bears");
    bears.closest("div").hidden = !demand;
    const unit = demand === "stroke" ? "slide_stroke" : "slide_bears";
    find("slide-bears-label").textContent = say(unit);
    const text = bears.value.trim().replace(",", ".");
    const stated = demand && text ? Number(text) / factor : null;
    const isWrong = stated !== null && !(stated > 0 && Number.isFinite(stated));
    bears.setAttribute("aria-invalid", String(isWrong));
    find("slide-bears-error").textContent = isWrong ? say("bears_refused") : "";
    if (!there.value && !hold.value) return null;
    const at = atWall
      ? { kind: "wall", value: WALLS[there.value] }
      : { kind: "casters", value: false };
    return {
      there: there.value ? at : null,
      kind: hold.value || null,
      bears: stated,
      isWrong,
    };
  }
  function slide() {
    if (shown?.run !== current || document.body.dataset.stage !== "complete") return;
    const [width, cg, ballast] = Object.values(SLIDERS).map(([, , at]) => at / 100);
    const { found } = shown;
    const choice = find("slide-fixed");
    const fixed = shown.run.request.pedestal ? choice.value : "not_fixed";
    choice.closest("div").hidden = !shown.run.request.pedestal;
    const hold = holdChosen();
    other = null;
    find("tried").textContent = "";
    if (hold?.isWrong) return compare(found, null);
    if (!(width || cg || ballast || hold || fixed !== "not_fixed"))
      return compare(found, null);
    const changes = { wider: 1 + width, lower: 1 - cg, ballast };
    other = {
      id: ++number,
      request: { ...current.request, changes, fixed, hold },
      since: performance.now(),
    };
    if (hold) tryHolder(other, found);
    else shakeChanged(other, found);
  }
  // a run of a plan under all motions that are of it
  function countRun(run, i, given = {}) {
    const { id, request } = run;
    return Promise.all(
      startsOf(data.earthquakes.length).map(async (first) => {
        const message = {
          kind: "count",
          id,
          request,
          run: i,
          given,
          first,
          last: Math.min(first + PART, data.earthquakes.length),
        };
        const { result, failure } = await ask(run, message);
        if (failure) fail(failure);
        return { first, ...result };
      }),
    );
  }
  // the object with a change under all motions, and the answer's own numbers of it
  async function shakeChanged(run, answered) {
    const { id, request } = run;
    const plan = await ask(run, { kind: "plan", id, request });
    if (plan.failure) return compare(answered, null);
    const parts = await countRun(run, 0);
    const { result } = await ask(
      run,
      { kind: "changed", id, request, parts, answered },
      true,
    );
    compare(answered, result);
    find("compared").dataset.took = String(performance.now() - run.since);
  }
  // what may hold it: first what the motions ask of it, then both under few of them
  async function tryHolder(run, answered) {
    const { id, request } = run;
    find("compared").classList.add("stale");
    find("tried").textContent = say("trying");
    const plan = await ask(run, { kind: "plan", id, request });
    if (plan.failure) return compare(answered, null);
    const roles = plan.result.roles.map(({ role }) => role);
    let asked = null;
    if (roles[0] === "asked") {
      const parts = await countRun(run, 0);
      const { bears } = request.hold;
      const message = { kind: "asked", id, request, parts, bears };
      asked = (await ask(run, message, true)).result;
      if (!(asked.bears > 0)) {
        compare(answered, null);
        find("tried").textContent = say("asks_nothing");
        return;
      }
    }
    const given = { bears: asked?.bears };
    const last = roles.length - 1;
    const parts = await Promise.all(
      [last - 1, last].map((i) => countRun(run, i, given)),
    );
    const message = { kind: "tried", id, request, parts, asked, answered };
    const { result, failure } = await ask(run, message, true);
    if (failure) return fail(failure);
    // what holds it is tried where it was chosen to stand
    const { there, kind } = request.hold;
    const stands = there && kind ? find("slide-there").selectedOptions[0] : null;
    compare(result.before, result.after, stands?.textContent);
    const { said, motions, levels } = result;
    const words = [
      speak.sentence(said),
      say(stands ? "tried_there_by" : "tried_by", { n: motions, levels }),
      ...inPlaneAlone(request, result.inSpace, asked),
    ];
    find("tried").replaceChildren(...bound(words.join(" ")));
    find("compared").dataset.took = String(performance.now() - run.since);
  }
  // of what moves in space and was tried in a plane, how it is had in space, if at all
  const OPTIONS = { bracket: "--bracket", cord: "--cord" };
  const standing = (there) => {
    if (!there) return [];
    return there.kind === "wall"
      ? [`--wall ${100 * there.value}cm`]
      : ["--casters free"];
  };
  function inPlaneAlone({ solid, hold: { there, kind } }, inSpace, asked) {
    if (!solid || inSpace) return [];
    if (!OPTIONS[kind]) return [say("tried_in_plane_alone")];
    const option = [...standing(there), `${OPTIONS[kind]} ${asked.bears}N`].join(" ");
    return [say("tried_in_plane", { option })];
  }
  function compare({ fraction, probability, leans = 0 }, after, stands = say("before")) {
    computed("helping");
    find("before").replaceChildren(...bound(stands));
    find("compared").classList.remove("stale");
    const valueOf = (each) => each?.value ?? each;
    const rows = [
      ["topples_column", valueOf(fraction), after?.fraction],
      ["risk_column", valueOf(probability), after?.probability],
    ];
    // what stands at no wall and in no tie never leans
    if (Math.max(leans, after?.leans) > data.constants.MANY_LEAN)
      rows.push(["leans_column", leans, after.leans]);
    find("compared").replaceChildren(
      ...rows.map(([title, before, now]) =>
        make(
          "tr",
          {},
          make("th", { scope: "row", textContent: say(title) }),
          make("td", { className: "number", textContent: percent(before) }),
          make("td", { className: "number", textContent: percent(now) }),
        ),
      ),
    );
  }

  // ---- the object under the motion that decides

  const scene = { of: null, response: null, timer: 0, at: 0 };
  let kernel = null;
  let building = null;
  async function draw(answer) {
    const {
      run: of,
      found: { deciding },
    } = answer;
    scene.of = of;
    kernel ??= await rockfragKernel(await unpacked(data.modules.history));
    const motion = (await ask(null, { kind: "motion", motion: deciding.motion }))
      .result;
    if (scene.of !== of) return;
    const { statue, pedestal, restitution, measure, place } = {
      measure: "PGA",
      ...of.request,
    };
    scene.dt = motion.dt;
    canvasOf(of.request.solid);
    if (of.request.solid) {
      inSpaceScene ??= sceneInSpace(data, find("scene"), () => paint());
      const response = await inSpaceScene.respond(
        of.request,
        deciding,
        async (m) => (await ask(null, { kind: "motion", motion: m })).result,
        (name) => unpacked(data.modules[name]),
      );
      if (scene.of !== of) return;
      Object.assign(scene, { response, statue, pedestal, dt: response.dt });
      describe(deciding, measure);
      scene.at = response.most;
      return paint();
    }
    if (!place.ground) building ??= floors(data, core);
    const ground = place.ground
      ? motion
      : building.floorMotion(place.floors[""], motion);
    const body = kernel.bodyOf({
      statue,
      pedestal,
      restitution:
        pedestal && restitution !== null ? [restitution, restitution] : restitution,
    });
    const scale = deciding.level / data.measures[measure].values[deciding.motion];
    scene.response = kernel.integrate({
      body,
      samples: ground.samples,
      dt: motion.dt,
      scale,
    });
    Object.assign(scene, { statue, pedestal, at: 0 });
    describe(deciding, measure);
    const { theta2, done } = scene.response;
    let most = 0;
    for (let k = 0; k < done; k++)
      if (Math.abs(theta2[k]) > Math.abs(theta2[most]) && Math.abs(theta2[k]) < 0.6)
        most = k;
    scene.at = most;
    paint();
  }
  let inSpaceScene = null;
  // in space the picture can be turned by keys
  function canvasOf(solid) {
    find("scene").tabIndex = solid ? 0 : -1;
    find("scene").setAttribute("role", solid ? "application" : "img");
  }
  function describe(deciding, measure) {
    const { unit } = data.measures[measure];
    const { fallen, history } = scene.response;
    const level = () => `${measure} ${local(deciding.level, 2)} ${unit}`;
    scene.words = () =>
      say("scene_words", {
        motion: data.names[deciding.motion],
        level: level(),
        what: say(fallen ? "falls" : "stays"),
      });
    scene.turns = Boolean(history);
    scene.title = () => say(deciding.falls ? "scene" : "scene_other");
    find("bump").hidden = Boolean(scene.pedestal);
    computed("drawing");
    sayScene();
  }
  // a base that is hit, runs a distance and is stopped: no record of accelerations
  // holds that
  function hit(event) {
    event.preventDefault();
    const [velocity, millimetres] = ["velocity", "distance"].map((name) =>
      Number(find(`bump-${name}`).value),
    );
    if (!(velocity > 0 && millimetres > 0)) return;
    const response = kernel.bump({
      statue: scene.statue,
      velocity,
      distance: millimetres / 1000,
    });
    Object.assign(scene, { response, dt: response.dt, at: 0, turns: false });
    scene.words = () =>
      say("bump_words", {
        velocity: local(velocity, 3),
        distance: local(millimetres, 3),
        what: say(response.fallen ? "falls" : "stays"),
      });
    scene.title = () => say("bump_title");
    sayScene();
    if (scene.timer) play();
    play();
  }
  function computed(place) {
    find(place).hidden = false;
    find(place).classList.remove("stale");
  }
  // what the picture shows, and how it is turned where it can be
  function sayScene() {
    const words = scene.words() + (scene.turns ? ` ${say("turn_view")}` : "");
    find("scene-words").replaceChildren(...bound(words));
    find("scene-title").textContent = scene.title();
    find("scene").setAttribute("aria-label", words);
  }
  const unpacked = (text) => rockfragUnpacked(rockfragBytes(text));
  function paint(what = scene, canvas = find("scene")) {
    const { response, statue, pedestal, at } = what;
    const context = canvas.getContext("2d");
    if (!response) return;
    const style = getComputedStyle(canvas);
    const colour = (name) => style.getPropertyValue(`--${name}`).trim();
    if (response.history) return inSpaceScene.paint(context, response, at, colour);
    const below = pedestal?.height ?? 0;
    const tall = below + statue.height;
    const zoom = Math.min(230 / tall, 320 / Math.max(tall, statue.width));
    context.clearRect(0, 0, 600, 300);
    context.fillStyle = colour("rule");
    context.fillRect(40, 280, 520, 3);
    const turn = ([x, y], angle, [px, py]) => {
      const s = Math.sin(angle);
      const c = Math.cos(angle);
      return [px + (x - px) * c + (y - py) * s, py - (x - px) * s + (y - py) * c];
    };
    const box = (width, bottom, height) => [
      [-width / 2, bottom],
      [width / 2, bottom],
      [width / 2, bottom + height],
      [-width / 2, bottom + height],
    ];
    const one = pedestal ? response.theta1[at] : 0;
    const two = response.theta2[at];
    const foot = [((one < 0 ? -1 : 1) * (pedestal?.width ?? 0)) / 2, 0];
    const contact = Math.min(statue.width, pedestal?.width ?? Infinity) / 2;
    const pivot = [(two - one < 0 ? -1 : 1) * contact, below];
    const fill = (corners, name) => {
      context.beginPath();
      corners.forEach(([x, y]) => context.lineTo(300 + zoom * x, 280 - zoom * y));
      context.closePath();
      context.fillStyle = colour(name);
      context.fill();
    };
    if (pedestal)
      fill(
        box(pedestal.width, 0, below).map((corner) => turn(corner, one, foot)),
        "faint",
      );
    fill(
      box(statue.width, below, statue.height).map((corner) =>
        turn(turn(corner, two - one, pivot), one, foot),
      ),
      "blue",
    );
  }
  function play() {
    if (!scene.response) return;
    if (scene.timer) {
      cancelAnimationFrame(scene.timer);
      scene.timer = 0;
      find("play").textContent = say("play");
      return;
    }
    const start = performance.now();
    find("play").textContent = say("pause");
    const step = (now) => {
      scene.at = Math.min(
        scene.response.done - 1,
        Math.max(0, Math.round((now - start) / 1000 / scene.dt)),
      );
      paint();
      scene.timer =
        scene.at < scene.response.done - 1 ? requestAnimationFrame(step) : 0;
      if (!scene.timer) find("play").textContent = say("play");
    };
    scene.timer = requestAnimationFrame(step);
  }

  // ---- objects that are kept

  const kept = [];
  const percent = (value) =>
    typeof value === "number" ? speak.say({ number: value, form: "percent" }) : "–";
  function drawKept() {
    const button = (id, action) => {
      const made = make("button", { type: "button", id, textContent: say(id) });
      made.addEventListener("click", action);
      return made;
    };
    const file = make("input", {
      type: "file",
      accept: ".csv,.yaml,.yml",
      id: "file",
      hidden: true,
    });
    file.addEventListener("change", () => openFile(file));
    const keepOne = button("keep", keep);
    keepOne.disabled = document.body.dataset.stage !== "complete";
    find("tools").replaceChildren(
      keepOne,
      button("save_csv", saveCsv),
      button("save_yaml", () => save("statue.yaml", lists.yamlOf(formTexts(), say))),
      button("open", () => file.click()),
      button(kept.length ? "print_all" : "print", () => print()),
      file,
    );
    find("columns").closest(".wide").hidden = !kept.length;
    find("columns").replaceChildren(...headings(), make("td"));
    const risk = ({ answer: { found } }) => found.main.value;
    kept.sort((a, b) => risk(b) - risk(a));
    find("objects").replaceChildren(
      ...kept.map((item, i) => {
        const row = rowOf(item, i);
        const remove = () => {
          kept.splice(kept.indexOf(item), 1);
          drawKept();
        };
        row.append(
          make(
            "td",
            {},
            button("load", () => fillForm(item.form)),
            button("remove", remove),
          ),
        );
        for (const each of row.querySelectorAll("button")) {
          each.removeAttribute("id");
          each.setAttribute(
            "aria-label",
            `${each.textContent}: ${item.answer.run.request.name}`,
          );
        }
        return row;
      }),
    );
  }
  const headings = () =>
    ["rank", "name", "topples_column", "risk_column", "page_to_do"].map((id) =>
      make("th", { scope: "col", textContent: say(id) }),
    );
  const calledOf = ({ name }) =>
    name === data.texts.en.the_object ? say("the_object") : name;
  function rowOf(
    {
      answer: {
        run: { request },
        found,
      },
    },
    i,
  ) {
    const { first } = found.said;
    const cells = [
      i + 1,
      speak.sentence(calledOf(request)),
      percent(found.fraction.value),
      percent(found.probability?.value),
      speak.sentence(first.at(-1)),
    ];
    return make("tr", {}, ...cells.map((text) => make("td", { textContent: text })));
  }
  async function keep() {
    const item = { form: shown.run.form, answer: shown };
    await scene.drawn;
    kept.push(Object.assign(item, { scene: stillOf(item.answer.run) }));
    drawKept();
  }
  // what is drawn of an object, without its motion
  function stillOf(run) {
    if (scene.of !== run || !scene.response) return null;
    const {
      response,
      response: { theta1, theta2 },
      statue,
      pedestal,
      at,
      words,
      title,
    } = scene;
    if (response.history) return { response, statue, pedestal, at, words, title };
    return {
      statue,
      pedestal,
      words,
      title,
      at: 0,
      response: { theta1: [theta1[at]], theta2: [theta2[at]] },
    };
  }
  // what a file does not say of the place and its shaking stays as it is
  const STAYS = ["place", "shaking"];
  function fillForm(values) {
    const isSaid = (group) => FIELDS[group].some(({ name }) => name in values);
    for (const { name, kind, options, group } of ALL) {
      if (STAYS.includes(group) && !isSaid(group)) continue;
      if (kind === "flag")
        inputs[name].checked = values[name] === true || values[name] === "true";
      else inputs[name].value = values[name] ?? options[0] ?? "";
    }
    update();
  }
  function save(name, text) {
    const link = make("a", {
      href: URL.createObjectURL(new Blob([text], { type: "text/plain" })),
      download: name,
    });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
  const saveCsv = () => save("objects.csv", lists.csvOf(kept.map(({ form }) => form)));
  async function openFile(input) {
    const [file] = input.files;
    const problem = find("file-error");
    problem.hidden = true;
    const complainOf = (text) => {
      problem.textContent = text;
      problem.hidden = false;
    };
    try {
      if (file.size > 200000) throw new Error(say("file_long"));
      const { forms, unused } = lists.read(file.name, await file.text(), say);
      const left = [];
      if (forms.length === 1) fillForm(forms[0]);
      else
        for (const [i, form] of forms.entries()) {
          const refusal = await answered(form);
          const row = i + 2; // below the titles
          if (refusal)
            left.push(
              say("row_left", {
                row,
                field: refusal.field ? say(refusal.field) : "",
                why: whyOf(refusal),
              }),
            );
          else await keep();
        }
      const notes = left.length ? [say("rows_left"), ...left] : [];
      if (unused.length) notes.push(unusedColumns(unused));
      if (notes.length) complainOf(notes.join(" "));
    } catch (error) {
      complainOf(say("file_unread", { why: error.message }));
    }
    input.value = "";
  }
  const unusedColumns = (titles) =>
    say("columns_unused", { columns: titles.slice(0, 12).join(", ").slice(0, 300) });
  function answered(form) {
    return new Promise((resolve) => {
      settle = resolve;
      fillForm(form);
    });
  }

  // ---- on paper: a sheet for each object that is kept, or for the one that is shown

  function drawSheets() {
    const items = [...kept];
    if (!kept.length && shown)
      items.push({ form: shown.run.form, answer: shown, scene: stillOf(shown.run) });
    find("sheets").replaceChildren(...(kept.length > 1 ? [rankedSheet()] : []));
    if (!items.length)
      find("sheets").append(make("p", { textContent: find("headline").textContent }));
    for (const {
      form,
      answer: { found },
      scene: still,
    } of items) {
      const said = saidOf(found);
      const canvas = make("canvas", { width: 600, height: 300 });
      const sheet = make(
        "section",
        { className: "sheet" },
        make("h2", {}, ...bound(said.headline)),
        make("p", {}, ...bound(said.screen)),
        make("p", {}, ...bound(typedIn(form))),
        make("dl", {}, ...linesAs(said)),
      );
      if (!kept.length) sheet.append(...tried());
      find("sheets").append(sheet);
      if (still) {
        sheet.append(
          make(
            "figure",
            {},
            canvas,
            make("figcaption", {}, ...bound(`${still.title()}: ${still.words()}`)),
          ),
        );
        paint(still, canvas);
      }
      const day = new Date().toISOString().slice(0, 10);
      const last = [...(data.made ? [say("made")] : []), say("no_substitute"), day];
      sheet.append(make("p", { className: "message", textContent: last.join(" ") }));
    }
  }
  // what the sliders try of the object that is shown, before and after
  function tried() {
    if (!other) return [];
    const fields = [...find("sliders").querySelectorAll(".field:not([hidden])")];
    const moved = fields.filter(
      (field) => field.querySelector("[type=range]")?.value > 0,
    );
    const words = moved.map((field) => field.querySelector("label").textContent);
    for (const choice of find("sliders").querySelectorAll("select"))
      if (!choice.closest("div").hidden && choice.selectedIndex > 0)
        words.push(
          `${choice.labels[0].textContent}: ${choice.selectedOptions[0].textContent}`,
        );
    const table = find("compared").closest("table").cloneNode(true);
    table.querySelector("tbody").removeAttribute("id");
    const said = find("tried").textContent;
    const does = said ? [make("p", {}, ...bound(said))] : [];
    return [
      make("p", { textContent: `${say("try")}: ${words.join("; ")}.` }),
      table,
      ...does,
    ];
  }
  function rankedSheet() {
    const table = make(
      "table",
      {},
      make("thead", {}, make("tr", {}, ...headings())),
      make("tbody", {}, ...kept.map(rowOf)),
    );
    return make(
      "section",
      { className: "sheet" },
      make("h2", { textContent: say("list") }),
      table,
    );
  }

  // ---- the beginning

  let core = null;
  let bodies = null;
  const lists = lists_(data, ALL);
  async function begin() {
    for (const [id, { language }] of Object.entries(data.texts))
      find("language").append(make("option", { value: id, textContent: language }));
    const wanted = navigator.language?.slice(0, 2);
    find("language").value = data.texts[wanted] ? wanted : "en";
    find("language").addEventListener("change", () => {
      translate();
    });
    find("play").addEventListener("click", play);
    find("bump").addEventListener("submit", hit);
    addEventListener("beforeprint", drawSheets);
    form.addEventListener("submit", (event) => event.preventDefault());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () =>
      paint(),
    );
    translate();
    const stop = (id) => {
      find("blocked").textContent = say(id);
      find("blocked").hidden = false;
    };
    if (typeof WebAssembly !== "object" || typeof DecompressionStream !== "function")
      return stop("no_wasm");
    find("done").textContent = say("starting");
    try {
      core = await rockfragCore(await unpacked(data.modules.core));
      bodies = objects(data, core);
      await startWorkers();
    } catch (error) {
      return stop(error.message === "no_workers" ? "no_workers" : "no_wasm");
    }
    update();
  }
  function translate() {
    choose(find("language").value);
    drawForm();
    drawSliders();
    drawKept();
    if (document.body.dataset.stage === "refused") update();
    if (!shown) return;
    show(shown);
    if (scene.words) sayScene();
    if (scene.timer) find("play").textContent = say("pause");
    slide();
  }
  begin();
})();
