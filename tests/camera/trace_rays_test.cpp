// SPDX-License-Identifier: Apache-2.0
// Many rays at once: each as it is traced by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "camera/lens/traced_ray.h"

namespace petzval::camera {
namespace {

// Rays of which some pass and others end at a rim, by total reflection or beside a surface.
struct Rays {
    std::vector<V3d> origins_mm, directions;
    std::vector<double> nm;

    explicit Rays(size_t count) {
        std::mt19937 random(7);
        std::uniform_real_distribution<double> place(-26, 26), tilt(-0.9, 0.9), wave(400, 700);
        for (size_t i = 0; i < count; ++i) {
            origins_mm.emplace_back(place(random), place(random), -30);
            directions.emplace_back(tilt(random), tilt(random), 2);
            nm.push_back(wave(random));
        }
    }
};

Lens thick_lens() {
    Prescription p;
    p.name = "thick";
    const Glass glass{"schott:N-BK7", Sellmeier{{{1.03961212, 0.00600069867},
                                                 {0.231792344, 0.0200179144},
                                                 {1.01046945, 103.560653}}}};
    LensSurface front, stop, back;
    front.curvature_1_mm = 1. / 22;
    front.thickness_mm = 12;
    front.semi_diameter_mm = 21;
    front.glass = glass;
    back.curvature_1_mm = -1. / 16;
    back.thickness_mm = 3;
    back.semi_diameter_mm = 24;
    stop.stop = true;
    stop.thickness_mm = 30;
    stop.semi_diameter_mm = 14;
    p.surfaces = {front, back, stop};
    return Lens(p);
}

void expect_as_by_themselves(const Rays& rays, std::span<const double> nm, Towards towards,
                             Clip clip) {
    const Lens lens = thick_lens();
    const size_t count = rays.origins_mm.size();
    std::vector<V3d> points(count), directions(count);
    std::vector<double> paths(count);
    std::vector<RayStatus> status(count);
    std::vector<int> ends(count);
    trace_rays(lens, {rays.origins_mm, rays.directions, nm}, towards, clip,
               {points, directions, paths, status, ends});
    std::array<int, 4> seen{};
    for (size_t i = 0; i < count; ++i) {
        const TracedRay one = trace_ray(lens, rays.origins_mm[i], rays.directions[i],
                                        nm.size() > 1 ? nm[i] : nm[0], towards, clip);
        ++seen[size_t(one.status)];
        EXPECT_EQ(status[i], one.status) << i;
        EXPECT_EQ(ends[i], one.end_surface) << i;
        if (one.status == RayStatus::Passed) {
            EXPECT_EQ(points[i], one.point) << i;
            EXPECT_EQ(directions[i], one.direction) << i;
            EXPECT_DOUBLE_EQ(paths[i], one.path_mm) << i;
        } else {
            EXPECT_TRUE(std::isnan(points[i].x) && std::isnan(paths[i])) << i;
        }
    }
    if (towards == Towards::Film && clip == Clip::Yes)
        for (const int of_status : seen) EXPECT_GT(of_status, 0);
}

TEST(TraceRays, IsWhatEachRayGivesByItself) {
    for (const Clip clip : {Clip::Yes, Clip::No})
        for (const size_t count : {401u, 3u}) {
            const Rays rays(count);
            const double line[] = {kLineD_nm};
            if (count > 100) expect_as_by_themselves(rays, rays.nm, Towards::Film, clip);
            if (count > 100) expect_as_by_themselves(rays, line, Towards::Film, clip);
            expect_as_by_themselves(rays, line, Towards::Scene, clip);
        }
    trace_rays(thick_lens(), {}, Towards::Film, Clip::Yes, {});
}

}  // namespace
}  // namespace petzval::camera
