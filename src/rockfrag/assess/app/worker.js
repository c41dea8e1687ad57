/* A worker of the page: it decodes the motions once, and counts and answers as it is
 * asked.
 */
let tools = null;
async function begin({ data, modules, samples }) {
  const fused = await rockfragUnpacked(modules.fused);
  let ensemble = WebAssembly.validate(fused) ? await rockfragEnsemble(fused) : null;
  if (!ensemble?.roundsOnce())
    ensemble = await rockfragEnsemble(await rockfragUnpacked(modules.plain));
  const motions = decoded(data, await rockfragUnpacked(samples));
  const core = await rockfragCore(await rockfragUnpacked(modules.core));
  const made = answer(data, core);
  const form = objects(data, core);
  tools = {
    ensemble,
    made,
    motions,
    form,
    bodies: plans(data, core, form),
    count: made.counter(
      ensemble,
      motions,
      await rockfragSpace(await rockfragUnpacked(modules.space)),
      await rockfragPlane(await rockfragUnpacked(modules.plane)),
    ),
    plans: new Map(),
  };
}
// samples are decimals: whole numbers over powers of ten, times the factor of their
// unit; bytes of equal rank together
function decoded({ samples: { counts, dts, factor, decimal } }, bytes) {
  const total = counts.reduce((a, b) => a + b, 0);
  const values = new Float64Array(total);
  const size = decimal ? 4 : 8;
  const plain = new Uint8Array(total * size);
  for (let rank = 0; rank < size; rank++)
    for (let i = 0; i < total; i++) plain[i * size + rank] = bytes[rank * total + i];
  if (!decimal) values.set(new Float64Array(plain.buffer));
  else {
    const whole = new Int32Array(plain.buffer);
    const powers = Array.from({ length: 23 }, (_, i) => Number(`1e${i}`));
    for (let i = 0; i < total; i++)
      values[i] = (whole[i] / powers[bytes[4 * total + i]]) * factor;
  }
  let end = 0;
  return counts.map((count, i) => {
    const begin = end;
    end += count;
    return { samples: values.subarray(begin, end), dt: dts[i] };
  });
}
function planOf({ id, request }) {
  const { plans, bodies, ensemble } = tools;
  if (!plans.has(id)) {
    if (plans.size > 4) plans.clear();
    plans.set(id, bodies.planOf(request, ensemble));
  }
  return plans.get(id);
}
const TASKS = {
  begin: async (task) => {
    await begin(task);
  },
  plan: (task) => ({ roles: planOf(task).map(({ role, name }) => ({ role, name })) }),
  count: (task) =>
    tools.count(task.request, { ...planOf(task)[task.run], ...task.given }, task),
  answer: ({ parts, earlier, ...task }) => {
    const runs = planOf(task);
    const outcomes = parts.map(
      (each, i) => each && tools.made.joined(task.request, runs[i], each),
    );
    return tools.made.found(task.request, runs, outcomes, tools.ensemble, earlier);
  },
  changed: ({ parts, answered, ...task }) =>
    tools.made.changed(
      task.request,
      tools.made.joined(task.request, planOf(task)[0], parts),
      answered,
    ),
  asked: ({ parts, bears, request }) =>
    tools.made.asked(request.hold.kind, parts, bears),
  tried: ({ parts, ...task }) => {
    const { made } = tools;
    const runs = planOf(task).filter(({ role }) => role !== "asked");
    const [free, held] = runs.map((run, i) => made.joined(task.request, run, parts[i]));
    const inSpace = Boolean(runs[0].solid);
    return { ...made.tried(task.request, { ...task, free, held }), inSpace };
  },
  motion: ({ motion }) => ({
    samples: tools.motions[motion].samples,
    dt: tools.motions[motion].dt,
  }),
};
onmessage = async ({ data: task }) => {
  try {
    postMessage({ id: task.id, result: await TASKS[task.kind](task) });
  } catch (error) {
    postMessage({
      id: task.id,
      refusal: error.field
        ? { field: error.field, text: error.id ?? "", values: error.values ?? {} }
        : null,
      failure: String(error.message ?? error),
    });
  }
};
