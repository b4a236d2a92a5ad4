"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const STORE = `evaluation-${data.evaluation}`;
  const WELCOME = 0, PRACTICE = 1, FIRST = 2;
  const COLUMNS = ["evaluation", "viewer", "language", "position", "presentation", "side", "clip", "aspect", "scale", "answer", "seconds"];
  const CANNOT = "";
  const main = document.getElementById("main");
  let keeps = true;
  let state = restored();
  let groups = [];
  let leave = () => {};

  // What is kept

  function fresh() {
    const language = navigator.language.toLowerCase().startsWith("ja") ? "ja" : "en";
    return { language, viewer: newId(), row: null, step: WELCOME, shown: {}, seen: {}, answers: {}, saved: false };
  }

  function restored() {
    try {
      const kept = JSON.parse(localStorage.getItem(STORE));
      if (kept && kept.answers && Number.isInteger(kept.step)) return kept;
    } catch (error) {
      keeps = false;
    }
    return fresh();
  }

  function keep() {
    try {
      localStorage.setItem(STORE, JSON.stringify(state));
    } catch (error) {
      keeps = false;
    }
  }

  function newId() {
    const bytes = crypto.getRandomValues(new Uint8Array(5));
    const digits = Array.from(bytes.slice(1), (byte) => byte.toString(16).padStart(2, "0")).join("");
    // Begun with a letter, a spreadsheet does not take it for a number.
    return "abcdf"[bytes[0] % 5] + digits.slice(1);
  }

  // Words and elements

  function text(id, values = {}) {
    const template = data.texts[state.language][id];
    return template.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? String(values[name]) : whole));
  }

  function make(tag, attributes = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
      if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
      else if (value === true) element.setAttribute(name, "");
      else if (value !== false) element.setAttribute(name, value);
    }
    element.append(...children);
    return element;
  }

  function show(...children) {
    leave();
    leave = () => {};
    groups = [];
    main.replaceChildren(...children);
    document.documentElement.lang = state.language;
    document.title = text("title");
    showHeader();
  }

  function showHeader() {
    const count = order().length, at = state.step - FIRST;
    document.getElementById("piece").textContent = state.step === WELCOME ? "" : data.piece;
    document.getElementById("bar").value = Math.min(Math.max(at, 0) / count, 1);
    const box = document.getElementById("languages");
    box.setAttribute("aria-label", text("language"));
    box.replaceChildren(
      ...Object.entries(data.languages).map(([code, name]) =>
        make("button", { type: "button", lang: code, id: `language_${code}`, "aria-pressed": String(code === state.language), onclick: () => speak(code) }, name)
      )
    );
  }

  function speak(language) {
    state.language = language;
    keep();
    render();
    document.getElementById(`language_${language}`).focus();
  }

  // Steps

  function order() {
    return data.orders[state.row ?? 0];
  }

  function go(step) {
    state.step = step;
    keep();
    render();
    window.scrollTo(0, 0);
    (main.querySelector("button.main, #play") || main).focus();
  }

  function render() {
    if (state.step === WELCOME) welcome();
    else if (state.step === PRACTICE) item(["practice"], 0);
    else if (state.step - FIRST < order().length) item(order()[state.step - FIRST], state.step - FIRST + 1);
    else thanks();
  }

  function welcome() {
    const pairs = order().filter((shown) => shown.length > 1).length;
    const questions = (order().length + pairs) * data.aspects.length * data.scales.length;
    const minutes = Math.ceil((order().length * 15 + questions * 4) / 60);
    const begin = make("button", { type: "button", class: "main", id: "begin", disabled: true, onclick: start }, text("begin"));
    const consent = make("input", { type: "checkbox", id: "consent", onchange: () => { begin.disabled = !consent.checked; } });
    const asked = /^#(\d{1,6})$/.exec(location.hash);
    const number = make("input", { type: "text", inputmode: "numeric", id: "number", maxlength: "6", autocomplete: "off", value: asked ? asked[1] : "" });
    const wrong = make("p", { class: "wrong", role: "alert", id: "wrong" });
    number.setAttribute("aria-describedby", "wrong");

    function start() {
      const typed = number.value.normalize("NFKC").trim();
      if (typed && !/^[1-9]\d*$/.test(typed)) {
        wrong.textContent = text("number_wrong");
        number.focus();
        return;
      }
      const rows = data.orders.length;
      const drawn = crypto.getRandomValues(new Uint32Array(1))[0];
      state.row = typed ? (Number(typed) - 1) % rows : drawn % rows;
      go(PRACTICE);
    }

    const said = [text("about", { count: order().length }), text("time", { minutes }), text("headphones"), keeps ? text("keeps") : text("keeps_nothing"), text("file"), text("keys")];
    show(
      make("h1", {}, text("welcome")),
      make("p", {}, text("piece", { piece: data.piece })),
      ...said.map((line) => make("p", {}, line)),
      make("div", { class: "field number" }, make("label", { for: "number" }, text("number")), number),
      wrong,
      make("div", { class: "field" }, consent, make("label", { for: "consent" }, text("consent"))),
      begin
    );
  }

  // One clip, or two beside each other

  function item(codes, position) {
    const pair = codes.length > 1;
    const hint = make("p", { id: "hint", role: "status" });
    const play = make("button", { type: "button", id: "play", "aria-describedby": "hint", onclick: () => player.play() });
    const questions = make("div", { id: "questions" });
    const next = make("button", { type: "button", class: "main", id: "next", onclick: () => forward() }, text("next"));
    const missing = make("p", { class: "wrong", role: "alert", id: "missing" });
    const player = pair ? pairPlayer(codes) : singlePlayer(codes[0]);
    const heading = position ? text("progress", { number: position, count: order().length }) : text("practice");
    show(
      make("h1", {}, heading),
      ...(position ? [] : [make("p", {}, text("practice_about"))]),
      player.element,
      make("div", { class: "controls" }, play, hint),
      questions
    );
    leave = player.close;
    let playing = false;

    function describe() {
      const seen = Boolean(state.seen[position]);
      play.textContent = playing ? text("playing") : seen ? text("again") : text("play");
      play.classList.toggle("main", !seen);
      play.setAttribute("aria-disabled", String(playing));
      hint.textContent = seen || playing ? "" : pair ? text("watch_pair") : text("first_watch");
      if (seen && !questions.firstChild) ask();
    }

    function ask() {
      for (const aspect of data.aspects) {
        questions.append(make("h2", {}, text(aspect)));
        for (const scale of data.scales) questions.append(...question(codes, position, aspect, scale));
      }
      questions.append(make("div", { class: "controls" }, next, missing));
    }

    function forward() {
      const open = groups.filter((group) => !group.answered());
      if (open.length) {
        missing.textContent = text("missing", { count: open.length });
        open[0].focus();
      } else {
        go(state.step + 1);
      }
    }

    player.on("playing", () => {
      playing = true;
      state.shown[position] ??= Date.now();
      keep();
      describe();
    });
    player.on("ended", () => {
      playing = false;
      const first = !state.seen[position];
      state.seen[position] = state.seen[position] || player.whole();
      keep();
      describe();
      if (first && groups.length) onward(null);
    });
    player.on("pause", () => { playing = false; describe(); });
    player.on("error", () => { playing = false; describe(); hint.textContent = text("cannot_play"); });
    describe();
  }

  function video(name) {
    const bytes = Uint8Array.from(atob(data.clips[name]), (letter) => letter.charCodeAt(0));
    const url = URL.createObjectURL(new Blob([bytes], { type: "video/mp4" }));
    const element = make("video", { src: url, playsinline: true, preload: "auto", disablepictureinpicture: true, disableremoteplayback: true });
    return {
      video: element,
      element,
      on: (event, run) => element.addEventListener(event, run),
      play() {
        if (!element.paused && !element.ended) return;
        element.currentTime = 0;
        element.play().catch(() => element.dispatchEvent(new Event("error")));
      },
      // Whether all of it was played, not only its end.
      whole() {
        let played = 0;
        for (let index = 0; index < element.played.length; index++) played += element.played.end(index) - element.played.start(index);
        return played > element.duration - 0.5;
      },
      close() {
        element.pause();
        URL.revokeObjectURL(url);
      },
    };
  }

  function singlePlayer(code) {
    return video(code);
  }

  // Both clips are one file, so that they never run apart; each half is drawn where this viewer has it.
  function pairPlayer([left, right]) {
    const stored = `${left}-${right}` in data.clips;
    const player = video(stored ? `${left}-${right}` : `${right}-${left}`);
    const canvases = [make("canvas", {}), make("canvas", {})];
    player.video.setAttribute("style", "position:absolute;width:1px;height:1px;opacity:0");
    const figures = canvases.map((canvas, index) => make("figure", {}, make("figcaption", {}, "AB"[index]), canvas));
    player.element = make("div", { class: "pair" }, player.video, ...figures);
    let frame = 0;

    function draw() {
      const width = player.video.videoWidth / 2, height = player.video.videoHeight;
      canvases.forEach((canvas, index) => {
        if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
        const half = stored ? index : 1 - index;
        canvas.getContext("2d").drawImage(player.video, half * width, 0, width, height, 0, 0, width, height);
      });
    }

    function loop() {
      draw();
      frame = player.video.paused ? 0 : requestAnimationFrame(loop);
    }

    player.on("loadeddata", draw);
    player.on("seeked", draw);
    player.on("playing", () => { cancelAnimationFrame(frame); loop(); });
    const close = player.close;
    player.close = () => { cancelAnimationFrame(frame); close(); };
    return player;
  }

  // Questions

  function question(codes, position, aspect, scale) {
    const asked = text(`${aspect}_${scale}`);
    if (codes.length === 1) return [group(codes[0], position, aspect, scale, asked, false)];
    return [
      make("p", { class: "asked" }, asked),
      ...codes.map((code, index) => group(code, position, aspect, scale, `${"AB"[index]}`, asked)),
    ];
  }

  function group(code, position, aspect, scale, legend, within) {
    const id = [position, code, aspect, scale].join(".");
    const numbers = Array.from({ length: data.steps }, (_, index) => String(index + 1));
    const inputs = [...numbers, CANNOT].map((value) =>
      make("input", { type: "radio", name: id, value, checked: state.answers[id]?.answer === value, onchange: () => answer(value) })
    );
    const ends = [text(`${scale}_low`), text(`${scale}_high`)];
    inputs[0].setAttribute("aria-label", `1: ${ends[0]}`);
    inputs[data.steps - 1].setAttribute("aria-label", `${data.steps}: ${ends[1]}`);
    const labels = inputs.map((input, index) =>
      index < data.steps ? make("label", {}, input, numbers[index]) : make("label", { class: "none" }, input, text("cannot_judge"))
    );
    const element = make(
      "fieldset",
      { class: within ? "twice" : "", "data-group": id },
      make("legend", within ? { "aria-label": `${legend}: ${within}` } : {}, legend),
      make("div", { class: "ends", "aria-hidden": "true" }, make("span", {}, ends[0]), make("span", {}, ends[1])),
      make("div", { class: "steps" }, ...labels)
    );

    function answer(value) {
      inputs.find((input) => input.value === value).checked = true;
      const seconds = Math.max((Date.now() - state.shown[position]) / 1000, 0);
      state.answers[id] = { answer: value, seconds: seconds.toFixed(1) };
      state.saved = false;
      keep();
      const open = groups.filter((one) => !one.answered()).length;
      if (!open) document.getElementById("missing").textContent = "";
    }

    const made = {
      element,
      answer,
      answered: () => id in state.answers,
      focus: () => (inputs.find((input) => input.checked) || inputs[0]).focus(),
    };
    groups.push(made);
    return element;
  }

  // The next question without an answer after this one, else the button that goes on.
  function onward(after) {
    const at = groups.indexOf(after);
    const open = [...groups.slice(at + 1), ...groups.slice(0, at + 1)].find((one) => !one.answered());
    if (open) open.focus();
    else document.getElementById("next").focus();
    document.activeElement.closest("fieldset, .controls")?.scrollIntoView({ block: "nearest" });
  }

  main.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || !groups.length) return;
    const here = groups.find((one) => one.element.contains(document.activeElement));
    const chosen = here || groups.find((one) => !one.answered());
    const digit = /^[0-9]$/.test(event.key) ? Number(event.key) : null;
    if (digit !== null && digit <= data.steps && chosen) {
      chosen.answer(digit ? String(digit) : CANNOT);
    } else if (event.key === "Enter" && here) {
      here.answer(document.activeElement.value);
    } else {
      return;
    }
    event.preventDefault();
    onward(chosen);
  });

  // The answers

  function rows() {
    const found = [];
    order().forEach((codes, index) => {
      const position = index + 1, pair = codes.length > 1;
      codes.forEach((code, side) => {
        for (const aspect of data.aspects) {
          for (const scale of data.scales) {
            const given = state.answers[[position, code, aspect, scale].join(".")];
            if (!given) continue;
            const presented = [pair ? "pair" : "single", pair ? ["left", "right"][side] : ""];
            found.push([data.evaluation, state.viewer, state.language, position, ...presented, code, aspect, scale, given.answer, given.seconds]);
          }
        }
      });
    });
    return found;
  }

  function thanks() {
    const file = `answers-${data.evaluation}-${state.viewer}.csv`;
    const saved = make("p", { role: "status", id: "saved" }, state.saved ? text("saved") : "");
    const save = () => {
      const csv = "\ufeff" + [COLUMNS, ...rows()].map((row) => row.join(",") + "\r\n").join("");
      const url = URL.createObjectURL(new Blob([csv], { type: "text/csv;charset=utf-8" }));
      const link = make("a", { href: url, download: file });
      document.body.append(link);
      link.click();
      link.remove();
      setTimeout(() => URL.revokeObjectURL(url), 60000);
      state.saved = true;
      keep();
      saved.textContent = text("saved");
    };
    const another = () => {
      if (!confirm(text("another_sure"))) return;
      const { language } = state;
      state = { ...fresh(), language };
      keep();
      render();
    };
    show(
      make("h1", {}, text("thanks")),
      make("p", {}, text("save_about", { file })),
      make("div", { class: "controls" }, make("button", { type: "button", class: "main", id: "save", onclick: save }, text("save"))),
      saved,
      make("div", { class: "controls" }, make("button", { type: "button", id: "another", onclick: another }, text("another")))
    );
  }

  render();
})();
