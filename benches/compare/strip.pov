// The view of cloakroom's default camera, square: the photograph behind a two-sided mirror strip turned by
// 10 degrees. POV-Ray's z is cloakroom's x, its x cloakroom's z. Declare Half_Width (cm).
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 5 }
camera {
    perspective location <0, 0, -100> look_at <0, 0, 50>
    angle 40 right x up y
}
plane {
    z, 50
    pigment {
        image_map { jpeg "bookshelf.jpg" once }
        scale <110, 137.5, 1> translate <-55, -68.75, 0>
    }
    finish { ambient 0 diffuse 0 emission 1 }
}
#declare Tip = <0, Half_Width * sin(radians(10)), Half_Width * cos(radians(10))>;
// Endless: its ends lie beyond the view.
#declare Side = <1000, 0, 0>;
mesh {
    triangle { -Tip - Side, Tip - Side, Tip + Side }
    triangle { -Tip - Side, Tip + Side, -Tip + Side }
    pigment { rgb 0 }
    finish { reflection 1 ambient 0 diffuse 0 }
}
