[...document.querySelectorAll("body, body *")]
  .filter((one) => {
    if (one.closest("svg") || getComputedStyle(one).display === "inline") return false;
    if (one.clientWidth === 0 || one.closest("[hidden], thead, .tools, option"))
      return false;
    return (
      one.scrollWidth > one.clientWidth + 1 ||
      one.getBoundingClientRect().right > innerWidth + 1
    );
  })
  .map(
    (one) =>
      one.tagName +
      "." +
      one.className +
      " " +
      one.scrollWidth +
      " > " +
      one.clientWidth +
      ": " +
      one.textContent.trim().slice(0, 60),
  );
