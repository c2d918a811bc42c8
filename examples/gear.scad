// A spur gear with involute teeth, a hub, a keyway and lightening holes.
modul = 2.5;
teeth = 24;
pressure_angle = 20;
width = 10;
bore = 10;
key = 3.2;
spokes = 6;
steps = 8; // points on each flank

$fn = 64;

pitch = modul * teeth / 2;
base = pitch * cos(pressure_angle);
tip = pitch + modul;
root = pitch - 1.25 * modul;

gear();

// Angle, in degrees, that the involute of the base circle has turned by where it reaches radius r.
function involute(r) = let (t = sqrt(max(0, pow(r / base, 2) - 1))) t * 180 / PI - atan(t);

function polar(r, angle) = [r * cos(angle), r * sin(angle)];

// Half of the angle of a tooth at radius r.
function half_angle(r) = 90 / teeth + involute(pitch) - involute(max(r, base));

function tooth(middle) = let (
  first = max(root, base),
  radii = [for (i = [0:steps]) first + (tip - first) * i / steps]
) [
  polar(root, middle - half_angle(first)),
  for (r = radii) polar(r, middle - half_angle(r)),
  for (i = [steps:-1:0]) polar(radii[i], middle + half_angle(radii[i])),
  polar(root, middle + half_angle(first))
];

function flatten(list) = [for (part = list) each part];

module gear() {
  difference() {
    union() {
      linear_extrude(height = width, convexity = 6)
        polygon(flatten([for (i = [0:teeth - 1]) tooth(360 * i / teeth)]));
      translate([0, 0, width / 2]) cylinder(h = width / 2 + 4, r = bore);
    }
    translate([0, 0, -1]) cylinder(h = width + 6, d = bore);
    translate([0, -key / 2, -1]) cube([bore / 2 + key / 2, key, width + 6]);
    for (i = [0:spokes - 1]) rotate(360 * (i + 0.5) / spokes)
      translate([(bore + root) / 2, 0, -1]) cylinder(h = width + 2, d = (root - bore) * 0.62);
    for (z = [-1, width - 1.5]) translate([0, 0, z]) difference() {
      cylinder(h = 2.5, r = root - 3);
      translate([0, 0, -1]) cylinder(h = 5, r = bore + 1.5);
    }
  }
}
