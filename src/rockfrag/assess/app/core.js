/* The compiled core in a page: arrays in its memory, and its functions by their names;
 * needs module.js.
 *
 * Whatever is estimated is computed in rockfrag.assess.core, here and by `rockfrag
 * assess` alike.
 */
async function rockfragCore(bytes) {
  "use strict";
  const { memory, layout, result, arrays, reserve, array, invoke } =
    await rockfragModule(bytes);
  let end = arrays;

  // an array of zeros; `values` is a view of it for as long as no memory is asked for
  function zeros(shape, Kind = Float64Array) {
    const count = shape.reduce((a, b) => a * b, 1);
    const at = end;
    end += (count * Kind.BYTES_PER_ELEMENT + 15) & ~15;
    reserve(end);
    const as = (shape) => ({
      shape,
      as,
      parameters: array(at, shape, Kind.BYTES_PER_ELEMENT),
      get values() {
        return new Kind(memory.buffer, at, count);
      },
    });
    const made = as(shape);
    made.values.fill(Kind === BigInt64Array ? 0n : 0);
    return made;
  }
  function put(values, shape = [values.length]) {
    const made = zeros(
      shape,
      Array.isArray(values) ? Float64Array : values.constructor,
    );
    made.values.set(values);
    return made;
  }
  const parametersOf = (given) =>
    given.flatMap(
      (each) => each.parameters ?? [typeof each === "boolean" ? Number(each) : each],
    );
  const call = (name, ...given) => invoke(name, ...parametersOf(given));
  // what a plain function chooses: the place of a text, or whether something is so
  function choose(name, ...given) {
    const found = new BigInt64Array(memory.buffer, result, 1);
    found[0] = 0n;
    call(name, ...given);
    return Number(found[0]);
  }
  // what is put meanwhile is forgotten afterwards
  function within(work) {
    const before = end;
    try {
      return work();
    } finally {
      end = before;
    }
  }
  return { zeros, put, call, choose, within, constants: layout.constants };
}
if (typeof module !== "undefined") module.exports = rockfragCore;
