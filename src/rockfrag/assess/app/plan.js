/* What is shaken for an answer: the object as it stands, with each property moved,
 * otherwise, and changed; its bodies are made by the core, as rockfrag.assess.standing
 * makes them.
 */
const plans = (data, core, form) => {
  "use strict";
  const { refuse, stepped } = form;
  const { LOWER, BALLAST, TOLERANCES } = data.constants;
  const spatial = inSpace(data, core);
  const { change } = spatial;
  const holders = holding(data, core, spatial);
  const number = (form) => (value) => ({ number: value, form });
  const [two, three, percent] = ["two", "three", "percent"].map(number);

  const UNCHANGED = { wider: 1, lower: 1, ballast: 0 };
  // roles, and bodies as the module of outcomes takes them; the object as it stands
  // first
  function planOf(request, ensemble) {
    const { hold, changes: some } = request;
    if (hold) {
      const now = (more) => planOf({ ...request, hold: null, ...more }, ensemble)[0];
      const stands = now({ changes: UNCHANGED, fixed: "not_fixed" });
      return holders.runsOf(hold, stands, now({ changes: some ?? UNCHANGED }));
    }
    const { pedestal, restitution: measured, place, changes } = request;
    const statue = changes ? changed(request.statue, changes) : request.statue;
    const body = (top, below = pedestal, factor = 1) => ({
      statue: top,
      pedestal: below,
      measured,
      restitution_factor: factor,
    });
    const joined = (top, below) => change("join", below, spatial.rowOf(top));
    const moving = (runs) =>
      request.solid ? spatial.planOf({ ...request, statue }, runs) : runs;
    const held = {
      to_pedestal: () => body(joined(statue, pedestal), null),
      to_floor: () => body(statue, null),
    }[pedestal && request.fixed];
    if (held) return moving([{ role: "now", body: held() }]);
    stands(body(statue), ensemble);
    if (measured !== null && measured > ensemble.bodyOf(body(statue)).largest)
      refuse("restitution", "gains_energy");
    const runs = [{ role: "now", body: body(statue) }];
    if (changes) return moving(runs);
    const move = (name, make) => {
      for (const factor of TOLERANCES[name])
        runs.push({ role: "moved", name, few: true, body: make(factor) });
    };
    const stretched = (block, width, height, mass) =>
      change("stretch", block, width, height, mass);
    move("width", (f) =>
      body(stretched(statue, f, 1, 1), pedestal && stretched(pedestal, f, 1, 1)),
    );
    move("cg_height", (f) => body(stretched(statue, 1, f, 1)));
    move("restitution", (f) => body(statue, pedestal, f));
    if (pedestal) move("mass", (f) => body(stretched(statue, 1, 1, f)));
    for (const floor of Object.keys(place.floors).filter(Boolean))
      runs.push({
        role: "moved",
        name: floor.slice(0, -1),
        few: true,
        floor,
        body: body(statue),
      });
    if (pedestal) {
      runs.push({
        role: "arrangement",
        name: "fixed_to_its_pedestal",
        change: "fix_object",
        values: {},
        body: body(joined(statue, pedestal), null),
      });
      runs.push({
        role: "arrangement",
        name: "on_the_floor",
        change: "fix_pedestal",
        values: {},
        body: body(statue, null),
      });
    }
    for (const { name, change, steps } of request.kind?.others ?? [])
      runs.push({
        role: "arrangement",
        name,
        change,
        values: {},
        body: body(stepped(statue, steps)),
      });
    const helps = (name, what, values = {}) =>
      runs.push({ role: "mitigation", change: name, body: what, values });
    const plateUnder = (block) => change("make_plate", block);
    const onPlate = (block) => joined(block, plateUnder(block));
    const plate = (block) => {
      const { width, height } = plateUnder(block);
      return { width: two(100 * width), thick: three(100 * height) };
    };
    if (!pedestal) helps("plate_under_it", body(onPlate(statue)), plate(statue));
    else {
      helps("plate_under_pedestal", body(statue, onPlate(pedestal)), plate(pedestal));
      if (spatial.isSo("carries_plate", statue, pedestal))
        helps("plate_under_object", body(onPlate(statue)), plate(statue));
    }
    helps("lower_centre", body(stretched(statue, 1, LOWER, 1)), {
      part: percent(1 - LOWER),
    });
    helps("ballast", body(change("add_ballast", statue, BALLAST)), {
      part: percent(BALLAST),
    });
    if (pedestal) {
      const half = change("make_lower", pedestal);
      helps("lower_pedestal", body(statue, half), { height: three(100 * half.height) });
    }
    for (const { body: each } of runs) stands(each, ensemble);
    return moving(runs);
  }
  // what cannot stand is said beside the width
  function stands(body, ensemble) {
    try {
      ensemble.bodyOf(body);
    } catch ({ message }) {
      refuse("width", `fault_${ROCKFRAG_FAULTS.indexOf(message)}`);
    }
  }
  // the object with a wider foot, a lower centre of gravity and ballast of a part of
  // its mass in its foot
  function changed(statue, { wider, lower, ballast }) {
    const heavier = ballast ? change("add_ballast", statue, ballast) : statue;
    return change("stretch", heavier, wider, lower, 1);
  }
  return { planOf };
};
if (typeof module !== "undefined") module.exports = plans;
