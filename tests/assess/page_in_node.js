// What the scripts of a page, which stand before this, make of forms: of a file with
// its data and the forms, as JSON.
const fs = require("fs");
const { data, forms } = JSON.parse(fs.readFileSync(process.argv[2]));
const bytes = (text) => Uint8Array.from(Buffer.from(text, "base64"));
const finite = (key, v) => (typeof v === "number" && !Number.isFinite(v) ? null : v);
const plain = (value) => JSON.parse(JSON.stringify(value, finite));
const modules = Object.fromEntries(
  Object.entries(data.modules).map(([name, text]) => [name, bytes(text)]),
);
begin({ data, modules, samples: bytes(data.packed) }).then(() => {
  const speak = catalogue(data.texts.en);
  const found = forms.map((form, id) => {
    try {
      const request = tools.form.requestOf(form);
      const count = data.earthquakes.length;
      const runs = TASKS.plan({ id, request }).roles;
      const parts = runs.map((_, run) =>
        [
          [0, 10],
          [10, count],
        ].map(([first, last]) => ({
          first,
          ...TASKS.count({ id, request, run, first, last }),
        })),
      );
      const answer = TASKS.answer({ id, request, parts });
      const at = runs.findIndex(({ role }) => role === "first");
      const only = parts.map((part, i) => (i === at ? part : null));
      const early = at < 0 ? null : plain(TASKS.answer({ id, request, parts: only }));
      const fix = (fixed) => {
        const other = { ...request, fixed };
        const task = { id: `${id} ${fixed}`, request: other };
        const part = TASKS.count({ ...task, run: 0, first: 0, last: count });
        return TASKS.changed({
          ...task,
          parts: [{ first: 0, ...part }],
          answered: answer,
        });
      };
      const fixed = request.pedestal ? ["to_pedestal", "to_floor"].map(fix) : null;
      // what may hold it, tried as the page tries it; in two parts
      const tried = (hold) => {
        const task = {
          id: `${id} ${JSON.stringify(hold)}`,
          request: { ...request, hold },
        };
        const roles = TASKS.plan(task).roles.map(({ role }) => role);
        const countOf = (run, given = {}) =>
          [
            [0, 7],
            [7, count],
          ].map(([first, last]) => ({
            first,
            ...TASKS.count({ ...task, run, given, first, last }),
          }));
        const asks = roles[0] === "asked";
        const { bears } = hold;
        const asked = asks ? TASKS.asked({ ...task, parts: countOf(0), bears }) : null;
        if (asked && !(asked.bears > 0)) return { asked };
        const given = { bears: asked?.bears };
        const last = roles.length - 1;
        const parts = [last - 1, last].map((run) => countOf(run, given));
        // with what each motion did at each level
        const outcomes = Object.fromEntries(
          ["free", "held"].map((name, i) => {
            const run = planOf(task)[last - 1 + i];
            const { motions, overturned, leaning } = tools.made.joined(
              task.request,
              run,
              parts[i],
            );
            return [
              name,
              { motions, overturned: [...overturned], leaning: [...leaning] },
            ];
          }),
        );
        const found = TASKS.tried({ ...task, parts, asked, answered: answer });
        return { asked, outcomes, ...found };
      };
      const held = (form.hold ?? []).map(tried).map(plain);
      const { first, details } = answer.said;
      return {
        answer: plain(answer),
        early,
        fixed,
        held,
        first: plain(first),
        details: plain(details),
        lines: first.map(speak.sentence),
      };
    } catch (error) {
      if (!error.field) return { failed: error.stack };
      const { en } = data.texts;
      const sentence =
        en[`${error.id}_refused`] ??
        en[error.id] ??
        ROCKFRAG_FAULTS[Number(error.id.slice(6))];
      return { refused: [error.field, error.id, sentence.endsWith(".")] };
    }
  });
  console.log(JSON.stringify(found));
});
