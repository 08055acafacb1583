// Pictures without values, with one value, with equal values and with values that are not finite: none may fail to be drawn.

const none = null;
const line = (points, stroke = "line") => ({ name: "a", points, stroke });
const panels = (values, rest = {}) => ({
  kind: "panels", title: "panels", rows: ["a"], columns: ["b"], x: ["speed in rpm", [1000, 2000, 3000]], y: ["torque in Nm", [-5, 5]], slider: none,
  quantities: [{ name: "efficiency", unit: "%", diverging: false, best: "highest", jumps: true, panels: [values] }], outside: [], marks: [], marked: "", powers: [1000], envelope: [], breakdown: none, ...rest,
});
const map = (values, rest = {}) => ({
  kind: "map", title: "map", unit: "", best: none, jumps: false, x: ["speed rpm", ["1000", "2000"]], y: ["torque Nm", ["5", "10"]], values, diverging: false, ends: none, hatched: [], marks: [], marked: "", crossed: none, unseen: none, ...rest,
});

export const degenerate = [
  { kind: "bars", title: "bars", over: "", height: "loss in W", names: [], bars: [] },
  { kind: "bars", title: "bars", over: "", height: "loss in W", names: ["a", "b"], bars: [{ label: "", shares: [0, none], above: "", measured: none, above_measured: "" }] },
  { kind: "bars", title: "bars", over: "x", height: "loss in W", names: ["a"], bars: [{ label: "-", shares: [-3], above: "x", measured: [0, 1], above_measured: "y" }] },
  map([]), map([none, none, none, none]), map([1, 1, 1, 1], { hatched: [true, true, true, true], unseen: 0.5 }), map([1, none, 3, 4], { crossed: [3, "least"], ends: [0, 10] }),
  map([1, 2], { y: ["torque", ["only"]] }), map([1, 2, 3, 4], { x: ["", ["low", "high"]] }), map([-1, -2, -3, -4], { diverging: true, x: ["", ["2", "1"]] }), map([1e-9, 2e-9, 5e12, 1], {}),
  { kind: "cloud", sizes: [], sized: "", title: "cloud", unit: "", axes: ["x", "y"], points: [], diverging: false },
  { kind: "cloud", sizes: [], sized: "", title: "cloud", unit: "", axes: ["x", "y"], points: [[1, 1, 1], [2, none, 1]], diverging: true },
  { kind: "lines", title: "lines", x: "x", y: "y", lines: [] }, { kind: "lines", title: "lines", x: "x", y: "y", lines: [line([])] },
  { kind: "lines", title: "lines", x: "x", y: "y", lines: [line([[1, 1]]), line([none, [1, none], [2, 2]], "dots")] },
  { kind: "areas", title: "areas", x: "x", y: "y", names: [], places: [], stacks: [] },
  { kind: "areas", title: "areas", x: "x", y: "y", names: ["a"], places: [1], stacks: [[none]] },
  { kind: "intervals", title: "intervals", x: "x", marks: [], key: ["found", "stated", "bounds"], list: [] },
  { kind: "intervals", title: "intervals", x: "x", marks: [0], key: ["found", "stated", "bounds"], list: [{ name: "a", at: 0, ends: none, before: none }] },
  panels(none), panels([none, none, none, none, none, none]), panels([98, 98, 98, 98, 98, 98]), panels([98, 97, none, 95, 94, 93], { outside: [[]], marks: [[1000, 5]] }),
  panels([1, 2, 3, 4, 5, 6], { quantities: [] }), panels([1, 2, 3, 4, 5, 6], { breakdown: { names: [], panels: [none] } }),
  { kind: "panes", title: "panes", x: "x", panes: [] }, { kind: "panes", title: "panes", x: "x", panes: [{ y: "y", lines: [] }, { y: "z in W", lines: [line([[0, 0], [1, 0]])] }] },
  { kind: "waterfall", title: "waterfall", unit: "W", ends: [["input", 0], ["output", 0]], losses: [] },
  { kind: "waterfall", title: "waterfall", unit: "W", ends: [["input", 10], ["output", 11]], losses: [["a", "", -1], ["b", "c", 2]] },
  { kind: "tornado", title: "tornado", x: "loss in W", base: 0, bars: [] },
  { kind: "tornado", title: "tornado", x: "loss in W", base: 5, bars: [{ name: "a", results: [5, 5], ends: ["", ""] }] },
];
