"""What the page of ``rockfrag app`` says while it computes is not called complete before it is."""

import json

from rockfrag.assess.app.writing import write_app

from .browsers import ANSWERED, QUICK_IN_ONE, opened, put, waited

FORM = {"width": "25 cm", "height": "1 m", "measure": "PGA", "level": "0.4 g"}
FORM |= {"years": "475"}

WATCH = """(() => {
  const read = (id) => document.getElementById(id).textContent;
  window.seen = [];
  const note = () => window.seen.push([read("done"), read("headline"), read("screen")]);
  const watcher = new MutationObserver(note);
  for (const id of ["done", "headline", "screen"]) {
    const what = { childList: true, characterData: true, subtree: true };
    watcher.observe(document.getElementById(id), what);
  }
})()"""


@QUICK_IN_ONE
def test_the_answer_changes_no_more_once_it_is_called_complete(
    browser, motions, tmp_path
):
    """It said "Complete." with "may topple", and two seconds later that this is open."""
    path = tmp_path / "assess.html"
    write_app(motions, FORM, path, made=True)
    opened(browser, path, ready=ANSWERED)
    browser.run(WATCH)
    put(browser, "#field-width", "31 cm")
    waited(
        browser, "window.seen.some(([done]) => done.startsWith('Complete') === false)"
    )
    waited(browser, ANSWERED)
    waited(browser, "window.seen.at(-1)[0].startsWith('Complete')")
    states = json.loads(browser.run("JSON.stringify(window.seen)"))
    begun = next(i for i, (done, *_) in enumerate(states) if "Complete" not in done)
    final = [said for done, *said in states[begun:] if "Complete" in done]
    assert final and all(said == final[0] for said in final)
    assert final[0][0] == browser.run("document.getElementById('headline').textContent")
