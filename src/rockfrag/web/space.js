/* A body in space in a page, under one to three components of motion: plain script, no
 * library; needs module.js.
 *
 *   const space = await rockfragSpace(bytes);  // of space.wasm, a Uint8Array
 *   const size = { width: 0.3, depth: 0.4, height: 1.2, mass: 200 };
 *   const body = space.bodyOf(rockfragSolid(size));
 *   const response = space.integrate({ body, x, y, dt: 0.01, scale: 1.5 });
 *
 * The module is made from the kernel that rockfrag.overturns calls in space: outcomes
 * and histories have its bits.
 */
async function rockfragSpace(bytes) {
  "use strict";
  const { memory, layout, call, arrays, reserve, read, write, array, run } =
    await rockfragModule(bytes);
  const { fields } = layout.call;
  const { constants } = layout;
  const { columns } = constants;
  const numbers = (at, count) => new Float64Array(memory.buffer, at, count);
  const bodyAt = call + fields.body.at;
  const inBody = (name) => bodyAt + fields.body.fields[name][0];

  // a polygon ([x, y] anticlockwise) or a rim ({ radius, centre }), the centre of
  // gravity [x, y, z] from where the base is drawn, the tensor about it in three rows,
  // a turn about the vertical [rad], one coefficient of friction, the height of its
  // face, how far a smooth wall stands from the edge nearest to it [m], and a bond of
  // four pads: its tension and shear [N], and how far out its pads are; null without
  function bodyOf({
    mass,
    centre,
    tensor,
    vertices = [],
    rim = null,
    turn = 0,
    friction = null,
    height = 0,
    wall = null,
    bond = null,
    g = constants.gravity,
  }) {
    if (vertices.length > constants.most)
      throw new Error(`base: more than ${constants.most} vertices.`);
    const grip = Math.min(friction ?? constants.sticks, constants.sticks);
    reserve(arrays);
    new Uint8Array(memory.buffer, call, layout.call.size).fill(0);
    write(layout.call, call, {
      mass,
      turn,
      gravity: g,
      wall: wall ?? NaN,
      tall: height,
      tension: bond?.tension ?? NaN,
      shear: bond?.shear ?? NaN,
      pads_at: bond?.padsAt ?? NaN,
      body: {
        count: vertices.length,
        rim: rim?.radius ?? 0,
        static: grip,
        kinetic: grip,
      },
    });
    numbers(call + fields.at[0], 3).set(centre);
    numbers(call + fields.tensor[0], 9).set(tensor.flat());
    numbers(inBody("centre"), 2).set(rim?.centre ?? [0, 0]);
    vertices.forEach(([x, y], i) => numbers(inBody("points") + 24 * i, 2).set([x, y]));
    run("describe");
    const { stands, body } = read(layout.call, call);
    if (!stands) throw new Error(ROCKFRAG_FAULTS[1]);
    const points = numbers(inBody("points"), 3 * body.count);
    return {
      record: new Uint8Array(memory.buffer.slice(bodyAt, bodyAt + fields.body.size)),
      height: body.height,
      rim: body.rim,
      nearest: body.nearest,
      g,
      centre: [...numbers(inBody("centre"), 2)],
      points: Array.from({ length: body.count }, (_, i) => [
        points[3 * i],
        points[3 * i + 1],
      ]),
    };
  }

  // largest horizontal and vertical acceleration from each sample on, and in the next
  // intervals that rest may skip
  function laterPeaks(samples, into) {
    const count = samples.length / 3;
    const levels = new Float64Array(count);
    const uprights = new Float64Array(count);
    for (let i = count - 1, level = 0, upright = 0; i >= 0; i--) {
      const x = samples[3 * i];
      const y = samples[3 * i + 1];
      levels[i] = Math.sqrt(x * x + y * y);
      uprights[i] = Math.abs(samples[3 * i + 2]);
      level = Math.max(level, levels[i]);
      upright = Math.max(upright, uprights[i]);
      into.set([level, upright, 0, 0], 4 * i);
      for (let j = i; j < count && j <= i + constants.window; j++) {
        into[4 * i + 2] = Math.max(into[4 * i + 2], levels[j]);
        into[4 * i + 3] = Math.max(into[4 * i + 3], uprights[j]);
      }
    }
  }

  // a motion stays in memory until another one is shaken by
  let loaded = null;
  function load(x, y, z) {
    const count = x.length;
    const peaksAt = arrays + 24 * count;
    const end = peaksAt + 32 * count;
    if (loaded?.x === x && loaded.y === y && loaded.z === z) return loaded;
    reserve(end);
    const samples = numbers(arrays, 3 * count);
    for (let i = 0; i < count; i++) {
      samples[3 * i] = x[i];
      samples[3 * i + 1] = y ? y[i] : 0;
      samples[3 * i + 2] = z ? z[i] : 0;
    }
    laterPeaks(samples, numbers(peaksAt, 4 * count));
    const parameters = [
      ...array(arrays, [count, 3], 8),
      ...array(peaksAt, [count, 4], 8),
    ];
    loaded = { x, y, z, end, parameters };
    return loaded;
  }

  // what becomes of a body, and where history is asked for its rows: centre of gravity,
  // quaternion, velocities, turn
  function integrate({ body, x, y = null, z = null, dt, scale = 1, history = false }) {
    const motion = load(x, y, z);
    const extra = Math.ceil(constants.after / dt);
    const rows = history ? x.length + extra + 2 : 0;
    reserve(motion.end + 8 * rows * columns);
    const table = numbers(motion.end, rows * columns).fill(NaN);
    new Uint8Array(memory.buffer, bodyAt, fields.body.size).set(body.record);
    write(layout.call, call, {
      scale,
      dt,
      gravity: body.g,
      extra,
      tolerance: constants.tolerance,
      cut: constants.cut,
    });
    numbers(call + fields.state[0], 15)
      .fill(0)
      .set([0, 0, body.height, 1]);
    run("integrate", ...motion.parameters, ...array(motion.end, [rows, columns], 8));
    const out = numbers(call + fields.outcome[0], constants.outcome);
    const fell = out[constants.fell] > 0;
    let done = 0;
    while (done < rows && !Number.isNaN(table[done * columns])) done++;
    return {
      overturned: fell,
      leans: out[constants.leans] > 0,
      certainTime: out[constants.certain],
      fallDirection: fell ? out[constants.azimuth] : NaN,
      peak: fell ? Infinity : out[constants.peak],
      peakTilt: out[constants.tilt],
      turn: out[constants.turned],
      walk: [out[constants.walk], out[constants.walk + 1]],
      // that a bond bears, for a unit of mass [N/kg]
      force: out[constants.held + 4 * constants.bond + 2],
      done,
      history: table.slice(0, done * columns),
    };
  }

  return {
    bodyOf,
    integrate,
    gravity: constants.gravity,
    columns,
    rests: constants.rests,
  };
}

// a box, or a cylinder where it is round, as bodyOf takes it; `inertia` about x, y and
// z, of uniform mass if null
function rockfragSolid({
  width,
  depth,
  height,
  mass,
  inertia = null,
  cgHeight = null,
  cgOffset = 0,
  round = false,
  turn = 0,
}) {
  const across = (mass * (0.75 * width * width + height * height)) / 12;
  const [xx, yy, zz] =
    inertia ??
    (round
      ? [across, across, (mass * width * width) / 8]
      : [
          (mass * (depth * depth + height * height)) / 12,
          (mass * (width * width + height * height)) / 12,
          (mass * (width * width + depth * depth)) / 12,
        ]);
  const solid = {
    mass,
    height,
    centre: [cgOffset, 0, cgHeight ?? height / 2],
    tensor: [
      [xx, 0, 0],
      [0, yy, 0],
      [0, 0, zz],
    ],
    turn,
  };
  if (round) return { ...solid, rim: { radius: width / 2, centre: [0, 0] } };
  const [x, y] = [width / 2, depth / 2];
  return {
    ...solid,
    vertices: [
      [-x, -y],
      [x, -y],
      [x, y],
      [-x, y],
    ],
  };
}
