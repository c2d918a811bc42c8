// A star knob: lobes flow into a hub and the hub into a stem; the bore and the seat of its nut are cut sharply.
lobes = 5;
radius = 22;    // to the middle of a lobe
lobe = 8;
height = 14;
stem = 9;
bore = 3.2;
nut = 6.5;      // across corners, half
$fe = 0.2;      // largest error of anything round

difference() {
  smooth_union(5) {
    sdf_cylinder(h = height, r = radius - 3, rounding = 3);
    for (i = [1:lobes])
      rotate(360 / lobes * i) translate([radius, 0, 0]) sdf_cylinder(h = height, r = lobe, rounding = 3);
    translate([0, 0, -height / 2 - 10]) cylinder(h = 20, r = stem);
  }
  cylinder(h = 100, r = bore, center = true);
  translate([0, 0, height / 2 - 6]) cylinder(h = 10, r = nut, $fn = 6);
}
