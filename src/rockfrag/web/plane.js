/* Bodies in a plane that something holds, or that may roll and slide, under many
 * motions at many levels; needs module.js.
 *
 *   const plane = await rockfragPlane(bytes);  // of plane.wasm, a Uint8Array
 *   const statue = { width: 0.3, height: 1.2, mass: 200 };
 *   const held = { bond_tension: 300, bond_shear: 1e9, bond_spread: 0.12 };
 *   const found = plane.count(plane.bodyOf({ statue, held }), motions, scales);
 *
 * The module is made from the kernels that rockfrag.overturns calls: outcomes have its
 * bits.
 */
async function rockfragPlane(bytes) {
  "use strict";
  const { memory, layout, call, arrays, reserve, read, write, array, run } =
    await rockfragModule(bytes);
  const { fields } = layout.call;
  const { constants } = layout;
  const COLUMNS = ["fell", "rocked", "leans", "loose", "force", "stroke"];
  // of what is not there
  const NOTHING = {
    friction: NaN,
    bond_tension: NaN,
    bond_shear: NaN,
    bond_spread: NaN,
    ties: 0,
    is_bracket: 0,
    tie_height: NaN,
    tie_reach: NaN,
    tie_stiffness: NaN,
    tie_damping: NaN,
    tie_strength: NaN,
    wall: NaN,
    plate: NaN,
    dish_radius: NaN,
    dish_friction: NaN,
    stroke: NaN,
    spring_stiffness: NaN,
    spring_strength: NaN,
    spring_yield: NaN,
  };
  // what describes a body stands before what the kernels work in
  const described = fields.work[0] ?? fields.work.at;

  // one block, or one on a pedestal, by the names of `rockfragStanding`, and what holds
  // it: numbers by the names above
  function bodyOf({ held = {}, ...given }) {
    reserve(arrays);
    new Uint8Array(memory.buffer, call, layout.call.size).fill(0);
    write(layout.call, call, {
      ...rockfragStanding(given),
      gravity: constants.gravity,
      ...NOTHING,
      ...held,
    });
    run("describe");
    const { fault } = read({ fields: { fault: fields.fault } }, call);
    if (fault !== 0) throw new Error(ROCKFRAG_FAULTS[fault]);
    return new Uint8Array(memory.buffer.slice(call, call + described));
  }

  // what motions do at factors on them, (motions, scales), each result likewise
  function count(body, motions, scales) {
    const each = scales.length / motions.length;
    const found = Object.fromEntries(
      COLUMNS.map((name) => [name, new Float64Array(scales.length)]),
    );
    motions.forEach(({ samples, dt }, m) => {
      const factorsAt = arrays + 8 * samples.length;
      const outcomesAt = factorsAt + 8 * each;
      const width = COLUMNS.length;
      reserve(outcomesAt + 8 * width * each);
      new Uint8Array(memory.buffer, call, described).set(body);
      write(layout.call, call, { dt });
      new Float64Array(memory.buffer, arrays, samples.length).set(samples);
      const factors = scales.subarray(m * each, (m + 1) * each);
      new Float64Array(memory.buffer, factorsAt, each).set(factors);
      run(
        "shake",
        ...array(arrays, [samples.length], 8),
        ...array(factorsAt, [each], 8),
        ...array(outcomesAt, [each, width], 8),
        ...array(outcomesAt, [0], layout.sample.size),
        ...array(outcomesAt, [0], layout.event.size),
      );
      const table = new Float64Array(memory.buffer, outcomesAt, width * each);
      for (const name of COLUMNS)
        for (let k = 0; k < each; k++)
          found[name][m * each + k] = table[k * width + constants[name]];
    });
    return found;
  }
  // a body as the kernels know it
  const recordOf = (body) =>
    body.slice(fields.body.at, fields.body.at + fields.body.size);
  return { bodyOf, recordOf, count, gravity: constants.gravity };
}
if (typeof module !== "undefined") module.exports = rockfragPlane;
