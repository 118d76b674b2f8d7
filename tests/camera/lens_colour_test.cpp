// SPDX-License-Identifier: Apache-2.0
// Where a lens focuses each wavelength: longitudinal colour against the closed forms of thin
// lenses, by rays that the renderer's trace traces.
#include <gtest/gtest.h>

#include <cmath>

#include "camera/lens/traced_ray.h"

namespace petzval::camera {
namespace {

// Schott's catalogue of 2023.
Glass n_bk7() {
    return {"schott:N-BK7", Sellmeier{{{1.03961212, 0.00600069867},
                                       {0.231792344, 0.0200179144},
                                       {1.01046945, 103.560653}}}};
}
Glass n_sf5() {
    return {"schott:N-SF5", Sellmeier{{{1.52481889, 0.011254756},
                                       {0.187085527, 0.0588995392},
                                       {1.42729015, 129.141675}}}};
}

constexpr double kFocal_mm = 100;

// As thin as can be, so that the closed forms hold.
LensSurface face(double curvature_1_mm, std::optional<Glass> behind) {
    LensSurface surface;
    surface.curvature_1_mm = curvature_1_mm;
    surface.thickness_mm = 1e-6;
    surface.semi_diameter_mm = 20;
    surface.glass = std::move(behind);
    return surface;
}

Lens touching_lens(std::vector<LensSurface> faces) {
    LensSurface stop = face(0, std::nullopt);
    stop.stop = true;
    faces.insert(faces.begin(), stop);
    faces.back().thickness_mm = kFocal_mm;
    Prescription p;
    p.name = "thin";
    p.surfaces = std::move(faces);
    return Lens(p);
}

// Where a ray near the axis, parallel to it in front, meets it behind the lens.
double focus_mm(const Lens& lens, double nm) {
    const double height_mm = 1e-3;
    const TracedRay ray =
        trace_ray(lens, {0, height_mm, -1}, {0, 0, 1}, nm, Towards::Film, Clip::Yes);
    EXPECT_EQ(ray.status, RayStatus::Passed);
    return ray.point.z - ray.point.y * ray.direction.z / ray.direction.y;
}

TEST(LensColour, ASingletFocusesBlueInFrontOfRed) {
    const Glass glass = n_bk7();
    const double bend = 1 / (2 * kFocal_mm * (glass.index(kLineD_nm) - 1));
    const Lens lens = touching_lens({face(bend, glass), face(-bend, std::nullopt)});
    const double d = focus_mm(lens, kLineD_nm);
    EXPECT_NEAR(d, kFocal_mm, 1e-3);
    const double blue = focus_mm(lens, kLineF_nm), red = focus_mm(lens, kLineC_nm);
    EXPECT_LT(blue, d);
    EXPECT_LT(d, red);
    // 1 / f = (n - 1) (c1 - c2), exactly at each wavelength; and f / V to first order.
    for (const double nm : {400., kLineG_nm, kLineF_nm, kLineC_nm, 700.})
        EXPECT_NEAR(focus_mm(lens, nm),
                    kFocal_mm * (glass.index(kLineD_nm) - 1) / (glass.index(nm) - 1), 1e-4)
            << nm;
    EXPECT_NEAR((red - blue) / (kFocal_mm / glass.abbe()), 1, 0.01);
}

// Powers in the ratio of the Abbe numbers bring F and C together: Conrady 1929, Applied Optics and
// Optical Design, ch. 4. What is left is the secondary spectrum, f (P1 - P2) / (V1 - V2), with the
// partial dispersion P = (nF - nd) / (nF - nC).
TEST(LensColour, AnAchromatCrossesTwice) {
    const Glass crown = n_bk7(), flint = n_sf5();
    const double v1 = crown.abbe(), v2 = flint.abbe();
    const double power1 = v1 / (v1 - v2) / kFocal_mm, power2 = -v2 / (v1 - v2) / kFocal_mm;
    const double bend1 = power1 / (crown.index(kLineD_nm) - 1);
    const double bend2 = power2 / (flint.index(kLineD_nm) - 1);
    const double front = bend1 / 2;
    const Lens lens = touching_lens({face(front, crown), face(front - bend1, flint),
                                     face(front - bend1 - bend2, std::nullopt)});
    const double d = focus_mm(lens, kLineD_nm), blue = focus_mm(lens, kLineF_nm);
    EXPECT_NEAR(d, kFocal_mm, 1e-3);
    EXPECT_NEAR(blue, focus_mm(lens, kLineC_nm), 1e-3);
    const auto partial = [](const Glass& g) {
        return (g.index(kLineF_nm) - g.index(kLineD_nm)) /
               (g.index(kLineF_nm) - g.index(kLineC_nm));
    };
    const double secondary_mm = kFocal_mm * (partial(flint) - partial(crown)) / (v1 - v2);
    EXPECT_GT(secondary_mm, 0.04);
    EXPECT_NEAR((blue - d) / secondary_mm, 1, 0.02);
    // Shortest somewhere in the green, longer to both sides: every focus beyond it comes up twice.
    int turns = 0;
    double before = focus_mm(lens, 420), here = focus_mm(lens, 425);
    for (double nm = 430; nm <= 700; nm += 5) {
        const double next = focus_mm(lens, nm);
        if ((next - here) * (here - before) < 0) {
            ++turns;
            EXPECT_GT(nm - 5, kLineF_nm);
            EXPECT_LT(nm - 5, kLineC_nm);
        }
        before = here;
        here = next;
    }
    EXPECT_EQ(turns, 1);
}

}  // namespace
}  // namespace petzval::camera
