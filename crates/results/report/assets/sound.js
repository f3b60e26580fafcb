// Speeds of the sound, and the file behind it.
((figure) => {
  const audio = figure.querySelector("audio");
  audio.preservesPitch = false;
  for (const button of figure.querySelectorAll("button")) {
    button.addEventListener("click", () => {
      audio.playbackRate = Number(button.dataset.speed);
      for (const other of figure.querySelectorAll("button")) {
        other.setAttribute("aria-pressed", String(other === button));
      }
    });
  }
  figure.querySelector("a").href = audio.src;
})(document.currentScript.parentElement);
