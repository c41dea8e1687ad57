/* A WebAssembly module made from the kernels, and its records by the names of their
 * fields; works in Node too.
 */
// bytes of a text in base 64
function rockfragBytes(text) {
  "use strict";
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}
// bytes that were packed by zlib
async function rockfragUnpacked(packed) {
  "use strict";
  const stream = new Blob([packed])
    .stream()
    .pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
async function rockfragModule(bytes) {
  "use strict";
  const { module, instance } = await WebAssembly.instantiate(bytes, {});
  const { memory, __heap_base: heap, ...functions } = instance.exports;
  const layout = JSON.parse(
    new TextDecoder().decode(WebAssembly.Module.customSections(module, "layout")[0]),
  );

  // memory: what a function returns, a call, and arrays after it, all aligned to eight
  // bytes
  const result = (heap.value + 15) & ~15;
  const call = result + 16;
  const arrays = (call + layout.call.size + 15) & ~15;
  let view = new DataView(memory.buffer);

  function reserve(end) {
    const missing = end - memory.buffer.byteLength;
    if (missing > 0) memory.grow(Math.ceil(missing / 65536));
    if (view.buffer !== memory.buffer) view = new DataView(memory.buffer);
    return view;
  }

  function read(record, at) {
    const found = {};
    for (const [name, place] of Object.entries(record.fields)) {
      found[name] = Array.isArray(place)
        ? number(place[1], at + place[0])
        : read(place, at + place.at);
    }
    return found;
  }

  function number(kind, at) {
    if (kind === "f8") return view.getFloat64(at, true);
    if (kind === "i8") return Number(view.getBigInt64(at, true));
    return view.getUint8(at) !== 0;
  }

  function write(record, at, values) {
    for (const [name, value] of Object.entries(values)) {
      const place = record.fields[name];
      if (!Array.isArray(place)) write(place, at + place.at, value);
      else if (place[1] === "f8") view.setFloat64(at + place[0], value, true);
      else if (place[1] === "i8") view.setBigInt64(at + place[0], BigInt(value), true);
      else view.setUint8(at + place[0], value ? 1 : 0);
    }
  }

  // an array as the kernels take one: owner and parent, count and size of items, place,
  // shape and strides
  function array(at, shape, size) {
    const strides = shape.map((_, axis) =>
      shape.slice(axis + 1).reduce((a, b) => a * b, size),
    );
    const count = shape.reduce((a, b) => a * b, 1);
    return [
      0,
      0,
      BigInt(count),
      BigInt(size),
      at,
      ...shape.map(BigInt),
      ...strides.map(BigInt),
    ];
  }

  // a function by its name; it returns its result, of those that have one
  function invoke(name, ...parameters) {
    functions[name](result, result + 8, ...parameters);
    return view.getFloat64(result, true);
  }
  const run = (name, ...parameters) => invoke(name, call, ...parameters);
  return {
    memory,
    layout,
    result,
    call,
    arrays,
    reserve,
    read,
    write,
    array,
    run,
    invoke,
  };
}

// numbers of a block that are not given as the kernels know them
function rockfragBlock(block) {
  return {
    width: block.width,
    height: block.height,
    mass: block.mass,
    inertia: block.inertia ?? NaN,
    cg_height: block.cgHeight ?? NaN,
    cg_offset: block.cgOffset ?? 0,
    lean: block.lean ?? 0,
  };
}

// a block, or one on a pedestal, as modules in the plane are told of it: `measured`
// restitution, none if null, the factor `restitution_factor` on each, and `rolling`,
// the restitution of a statue on a round base, NaN where it stands on another one
function rockfragStanding({
  statue,
  pedestal = null,
  measured = null,
  restitution_factor = 1,
  rolling = null,
}) {
  return {
    statue: rockfragBlock(statue),
    pedestal: rockfragBlock(pedestal ?? statue),
    stacked: pedestal ? 1 : 0,
    has_ratios: measured !== null || restitution_factor !== 1 || rolling !== null,
    below: measured ?? NaN,
    above: rolling ?? measured ?? NaN,
    restitution_factor,
  };
}

// why a body cannot stand, by the fault that its description leaves
const ROCKFRAG_FAULTS = [
  "",
  "A centre of gravity is not above its base, so the block cannot stand.",
  "The statue's base does not lie on the pedestal.",
  "The statue's centre of gravity is not above the part of its base that lies on the pedestal.",
  "A centre of gravity is not above its base once the pedestal's lean is counted.",
  "The statue could touch the ground beside its pedestal before anything has fallen.",
  "restitution: it would gain energy or is no ratio.",
];

// displacement of the ground for the eye [m]: integrated twice, slow drift filtered out
function rockfragDisplacement(samples, dt) {
  const keep = Math.exp(-2 * Math.PI * 0.15 * dt);
  const found = new Float64Array(samples.length);
  let velocity = 0;
  let place = 0;
  for (let k = 1; k < samples.length; k++) {
    velocity = keep * (velocity + samples[k] * dt);
    place = keep * (place + velocity * dt);
    found[k] = place;
  }
  return found;
}
