// A nameplate whose letters are drawn from strokes: rounded lines between points of a small grid.
word = "OGEE";
size = 18;     // height of the letters
stroke = 3.2;
relief = 2.5;
plate = 3;
margin = 7;

$fn = 32;

advance = size * 0.78;
width = advance * (len(word) - 1) + size * 0.56;

difference() {
  tablet(0, plate);
  for (side = [-1, 1]) translate([width / 2 + side * (width / 2 + margin + 3), size / 2, -1]) {
    cylinder(h = plate + 2, d = 3.4);
    translate([0, 0, plate - 0.6]) cylinder(h = 3, d1 = 3.4, d2 = 7);
  }
}
difference() {
  tablet(0, plate + 1);
  translate([0, 0, -1]) tablet(1.4, plate + 3);
}
for (i = [0:len(word) - 1]) translate([i * advance, 0, plate - 0.5])
  linear_extrude(height = relief + 0.5) letter(word[i]);

module tablet(inset, h) {
  hull() for (x = [-3, width + 3], y = [0, size])
    translate([x, y, 0]) cylinder(h = h, r = margin - inset);
}

// Strokes of a letter, each a list of points in a box 0.56 wide and 1 high.
function arc(cx, cy, rx, ry, from, to, n = 16) = [
  for (i = [0:n]) let (a = from + (to - from) * i / n) [cx + rx * cos(a), cy + ry * sin(a)]
];

function strokes(c) =
  c == "O" ? [arc(0.28, 0.5, 0.28, 0.5, 0, 360, 32)] :
  c == "G" ? [concat(arc(0.28, 0.5, 0.28, 0.5, 50, 360), [[0.3, 0.5]])] :
  c == "E" ? [[[0.5, 1], [0.02, 1], [0.02, 0], [0.5, 0]], [[0.02, 0.52], [0.42, 0.52]]] :
  c == "A" ? [[[0, 0], [0.28, 1], [0.56, 0]], [[0.1, 0.34], [0.46, 0.34]]] :
  c == "N" ? [[[0.02, 0], [0.02, 1], [0.54, 0], [0.54, 1]]] :
  assert(false, str("no strokes for ", c)) [];

module letter(c) {
  for (line = strokes(c), i = [0:len(line) - 2])
    hull() for (p = [line[i], line[i + 1]]) translate(p * size) circle(d = stroke, $fn = 20);
}
