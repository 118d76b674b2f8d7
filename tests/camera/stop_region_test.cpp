// SPDX-License-Identifier: Apache-2.0
// Regions of the stop whose rays pass a target, and the map of a lens that they come from: against
// rays that are traced through the lens itself.
#include <gtest/gtest.h>

#include "camera/targets/list_target.h"
#include "camera/targets/stop_search.h"
#include "core/sampling/warp.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/targets.h"

namespace petzval::camera {
namespace {

using test::Mean;
using test::Moments;
using test::Random;

const V2i kStop_px(960, 640);

/// A cell of a camera's film.
struct Seen {
    const char* name;
    StopCamera camera;
    V2f film;
    float focus_m;  ///< about; distances of targets start at a third of it
};

StopCamera lens(const std::string& name, double from_infinity_mm = 0) {
    LensCameraInput in = test::input_of(name, DispersionMode::Shared);
    in.film_mm += from_infinity_mm;
    return std::make_shared<const LensCamera>(std::move(in));
}
StopCamera folded_singlet() {
    const Glass glass{"crown", IndexTable{{{400, 1.53}, {587, 1.517}, {700, 1.513}}}};
    return std::make_shared<const AberratedLensCamera>(
        AberratedLens{M44f(), Singlet::bent(glass, 50, 0.8), Iris(Disk{}, 9), 1, 0.5f, 1.6f,
                      DispersionMode::Split});
}

std::vector<Seen> cameras() {
    const V2f middle(0.5f), corner(0.12f, 0.9f);
    return {{"Takumar", lens(test::kTakumar, 3), middle, 0.88f},
            {"Takumar", lens(test::kTakumar, 3), corner, 0.88f},
            {"Takumar", lens(test::kTakumar, 6.2), V2f(0.3f, 0.4f), 0.45f},
            {"double Gauss", lens(test::kGauss), corner, 9},
            {"double Gauss", lens(test::kGauss, 8), V2f(0.3f, 0.4f), 1.3f},
            {"fisheye", lens(test::kFisheye), corner, 2},
            {"anamorphic", lens("schneider-anamorphic-31mm"), V2f(0.06f, 0.95f), 2},
            {"singlet", folded_singlet(), middle, 1}};
}

V2f in_cell(const FilmCell& cell, V2f u) {
    return cell.first + u * (cell.last - cell.first);
}

/// A ray of a film point of a cell through a point of its stop.
struct DrawnRay {
    StopPoint at;
    StopRay ray;
};
/// Eight rays of a cell that no rim stops, at wavelengths from 430 to 690 nm or at line d.
std::array<DrawnRay, 8> clear_rays(const Seen& seen, const FilmCell& cell, Random& random,
                                   bool coloured) {
    const auto reach = static_cast<float>(stop_reach_mm(seen.camera));
    std::array<DrawnRay, 8> out;
    for (size_t count = 0; count < 8;) {
        std::array<StopPoint, 8> points;
        for (StopPoint& p : points)
            p = {in_cell(cell, random.next2()), uniform_disk(random.next2()) * reach,
                 coloured ? 430 + 260 * random.next() : kMiddle_nm};
        const auto rays = rays_through(seen.camera, points);
        for (size_t i = 0; i < 8 && count < 8; ++i)
            if (rays[i].clear) out[count++] = {points[i], rays[i]};
    }
    return out;
}

/// A target that a ray passes, at a random distance and of a random size, in the world.
Target target_on(const Seen& seen, const StopRay& ray, Random& random) {
    const Pose& pose = pose_of(seen.camera);
    const auto world = [&](const V3d& v) { return pose.to_world(V3f(v)); };
    const V3d direction = ray.direction.normalized();
    const float radius = std::pow(10.f, -4 + 2.5f * random.next());
    const V3d aside = V3d(random.direction()) * std::sqrt(double(random.next()));
    if (random.next() < 0.1f) {
        const V3d beside = aside - direction * aside.dot(direction);
        return {world((direction + beside * (0.99 * double(radius))).normalized()), radius, true};
    }
    const double distance_m = double(seen.focus_m) * std::pow(10., 2 * double(random.next()) - 0.5);
    return {pose.origin + world(ray.origin_m + direction * distance_m +
                                aside * (0.99 * distance_m * double(radius))),
            static_cast<float>(distance_m) * radius};
}

bool has_squares(const StopRegion& region) {
    for (size_t i = 0; i < region.size(); ++i)
        if (!region.is_ellipse(i)) return true;
    return false;
}

/// Shares, of rays that pass a target, of those that the cell does not know.
struct Counts {
    int rays = 0, unlisted = 0, unseen = 0, beyond_reach = 0, outside = 0, squares = 0;
};
Counts counts_of(const Seen& seen, uint32_t seed) {
    const FilmCell cell = test::cell_about(seen.film, kStop_px);
    const auto map = StopMap::of(seen.camera, cell);
    Random random(seed);
    Counts out;
    if (!map) return out;
    for (int batch = 0; batch < 250; ++batch)
        for (const DrawnRay& drawn : clear_rays(seen, cell, random, batch % 2 == 1)) {
            const Target target = target_on(seen, drawn.ray, random);
            const auto listed = list_target(target, *map, pose_of(seen.camera), kStop_px,
                                            iris_area_mm2(seen.camera));
            if (listed && (listed->is_sharp || listed->met > 0.25f)) continue;
            ++out.rays;
            if (!listed) {
                ++out.unlisted;
                continue;
            }
            // The film point may lie anywhere in its pixel.
            const V2f middle = drawn.at.film + (random.next2() - V2f(0.5f)) / V2f(kStop_px);
            out.unseen += !listed->seen_from.contains(FilmOctagon::along(middle));
            const V2f stop = map->on_disc(drawn.at.stop_mm);
            const StopMap::Rays rays = map->rays(drawn.at.film, drawn.at.nm);
            if (!(landing(at(rays, stop), *listed).length() <= reach_at(*map, *listed, stop)))
                ++out.beyond_reach;
            StopSearch search({map.get(), &*listed, drawn.at.film, drawn.at.nm}, rays);
            if (!search.region.empty()) correct(seen.camera, {&search, 1});
            out.outside += search.region.empty() || !(search.region.density(stop) > 0);
            out.squares += has_squares(search.region);
        }
    return out;
}

// What a region leaves out is found by ordinary rays alone: single bright pixels.
TEST(StopRegions, HoldTheRaysThatPassTheirTarget) {
    Counts all;
    for (const Seen& seen : cameras()) {
        const Counts counts = counts_of(seen, 1);
        EXPECT_GT(counts.rays, 800) << seen.name;
        const int lost = counts.unlisted + counts.unseen + counts.beyond_reach + counts.outside;
        // In the corner of the anamorphic lens rims leave a strip of the stop that folds.
        const bool folds = seen.name == std::string("anamorphic");
        EXPECT_LE(lost, counts.rays / (folds ? 100 : 750))
            << seen.name << ' ' << seen.focus_m << ": of " << counts.rays << " rays "
            << counts.unlisted << " see a target that is not listed, " << counts.unseen
            << " one that their pixel does not know, " << counts.beyond_reach
            << " are beyond its reach, " << counts.outside << " outside its region";
        EXPECT_LE(counts.outside, folds ? counts.rays / 500 : 0)
            << seen.name << ' ' << seen.focus_m;
        all.squares += counts.squares;
    }
    EXPECT_GT(all.squares, 100) << "caustics are among them";
}

/// Rays of a cell that pass a target of 2 mm two metres away, and those of them that no region
/// holds.
struct Missed {
    int rays = 0, missed = 0;
};
Missed missed_beside_caustics(const Seen& seen) {
    const V2f half(0.005f);
    const FilmCell cell{seen.film - half, seen.film + half};
    const auto map = StopMap::of(seen.camera, cell);
    if (!map) return {};
    const Pose& pose = pose_of(seen.camera);
    std::array<StopPoint, 8> points;
    points.fill({seen.film, map->stop_mm(V2f(0.f)), kMiddle_nm});
    const StopRay middle = rays_through(seen.camera, points)[0];
    const V3d at = middle.origin_m + 2. * middle.direction.normalized();
    const auto listed = list_target({pose.origin + pose.to_world(V3f(at)), 0.002f}, *map, pose,
                                    kStop_px, iris_area_mm2(seen.camera));
    Missed out;
    if (!listed) return out;
    Random random(5);
    for (int batch = 0; batch < 1 << 15; ++batch)
        for (const DrawnRay& drawn : clear_rays(seen, cell, random, false)) {
            const V3d direction = drawn.ray.direction.normalized();
            if (!((at - drawn.ray.origin_m).cross(direction).length() < 0.002)) continue;
            ++out.rays;
            StopSearch search({map.get(), &*listed, drawn.at.film, drawn.at.nm},
                              map->rays(drawn.at.film, drawn.at.nm));
            if (!search.region.empty()) correct(seen.camera, {&search, 1});
            out.missed += !(search.region.density(map->on_disc(drawn.at.stop_mm)) > 0);
        }
    return out;
}

// Ways bend there within the ellipse that stands for one.
TEST(StopRegions, HoldRaysBesideCaustics) {
    int rays = 0;
    for (const V2f& film : {V2f(0.5f), V2f(0.25f, 0.5f), V2f(0.3f, 0.4f)})
        for (const char* name : {"double-gauss-100mm-f2", "takumar-50mm-f1.2",
                                 "schneider-anamorphic-31mm", "kodak-petzval-100mm-f2"}) {
            const Missed found = missed_beside_caustics({name, lens(name), film, 2});
            rays += found.rays;
            EXPECT_EQ(found.missed, 0) << name << ' ' << film << ", of " << found.rays;
        }
    EXPECT_GT(rays, 10000);
}

// Where the map is straight one ellipse does, however small the target: strips would be larger.
TEST(StopRegions, OfTinyTargetsAreOneEllipse) {
    const StopCamera thin = std::make_shared<const ThinLensCamera>(
        ThinLens{M44f(), 0.47f, 1.5f, Iris(Disk{}, 18), 1.f});
    const FilmCell cell = test::cell_about(V2f(0.4f, 0.6f), kStop_px);
    const auto map = StopMap::of(thin, cell);
    ASSERT_TRUE(map);
    const Pose& pose = pose_of(thin);
    Random random(7);
    for (int i = 0; i < 200; ++i) {
        const V2f film = in_cell(cell, random.next2());
        std::array<StopPoint, 8> points;
        points.fill({film, map->stop_mm(uniform_disk(random.next2()) * 0.8f), kMiddle_nm});
        const StopRay ray = rays_through(thin, points)[0];
        const double away_m = 2 + 20 * double(random.next());
        const V3d at = ray.origin_m + away_m * ray.direction.normalized();
        const float radius_m = float(away_m) * std::pow(10.f, -5 + 1.5f * random.next());
        const auto listed = list_target({pose.origin + pose.to_world(V3f(at)), radius_m}, *map,
                                        pose, kStop_px, iris_area_mm2(thin));
        ASSERT_TRUE(listed);
        const StopRegion region(*map, map->rays(film, kMiddle_nm), *listed);
        ASSERT_EQ(region.size(), 1u) << away_m << ' ' << radius_m;
        EXPECT_TRUE(region.is_ellipse(0)) << away_m << ' ' << radius_m;
    }
}

// A region's points are drawn with the density that it says: over the plane it comes to 1, and its
// inverse, over points that are drawn, to the area that has a density.
TEST(StopRegions, DrawTheirPointsByTheirDensity) {
    int overlaps = 0, of_squares = 0;
    for (const Seen& seen : cameras()) {
        const FilmCell cell = test::cell_about(seen.film, kStop_px);
        const auto map = StopMap::of(seen.camera, cell);
        ASSERT_TRUE(map) << seen.name;
        Random random(2);
        int regions = 0;
        while (regions < 6) {
            const DrawnRay drawn = clear_rays(seen, cell, random, false)[0];
            const auto listed =
                list_target(target_on(seen, drawn.ray, random), *map, pose_of(seen.camera),
                            kStop_px, iris_area_mm2(seen.camera));
            if (!listed || listed->is_sharp || listed->met > 0.25f) continue;
            StopSearch search({map.get(), &*listed, drawn.at.film, drawn.at.nm},
                              map->rays(drawn.at.film, drawn.at.nm));
            StopRegion& region = search.region;
            if (region.empty()) continue;
            correct(seen.camera, {&search, 1});
            ++regions;
            of_squares += has_squares(region);
            V2f low(INFINITY), high(-INFINITY);
            Moments inverse;
            for (int i = 0; i < 4000; ++i) {
                const float pick = random.next();
                const V2f s = region.sample(pick, random.next2());
                const float density = region.density(s);
                // Rounding may leave a point at a rim outside.
                inverse.add(density > 0 ? 1 / double(density) : 0);
                overlaps += density * region.area() > 1.5f;
                low = V2f(std::min(low.x, s.x), std::min(low.y, s.y));
                high = V2f(std::max(high.x, s.x), std::max(high.y, s.y));
            }
            const V2f margin = (high - low) * 0.05f;
            const FilmCell box{low - margin, high + margin};
            const V2f size = box.last - box.first;
            const double area = double(size.x) * double(size.y);
            Moments covered, whole;
            for (int i = 0; i < 8000; ++i) {
                const double density = double(region.density(in_cell(box, random.next2())));
                covered.add(density > 0 ? area : 0);
                whole.add(density * area);
            }
            EXPECT_TRUE(test::agrees(whole, 1)) << seen.name << ": " << Mean(whole);
            EXPECT_TRUE(test::agrees(Mean(covered) - Mean(inverse), 0, 1e-3 * covered.mean()))
                << seen.name << ": " << Mean(covered) << ", " << Mean(inverse);
        }
    }
    EXPECT_GT(overlaps, 0);
    EXPECT_GT(of_squares, 0);
}

// By how much the map is off is known: places and slopes of rays that it was not fitted to.
TEST(StopMaps, AreAsGoodAsTheySay) {
    for (const Seen& seen : cameras()) {
        const FilmCell cell = test::cell_about(seen.film, kStop_px);
        const auto map = StopMap::of(seen.camera, cell);
        ASSERT_TRUE(map) << seen.name;
        Random random(3);
        int rays = 0, worse = 0, beyond = 0;
        double most = 0;
        for (int batch = 0; batch < 250; ++batch)
            for (const DrawnRay& drawn : clear_rays(seen, cell, random, batch % 2 == 1)) {
                const V2f stop = map->on_disc(drawn.at.stop_mm);
                ++rays;
                if (stop.length() > 1) {
                    ++beyond;
                    continue;
                }
                const f4 mapped = at(map->rays(drawn.at.film, drawn.at.nm), stop);
                const auto traced = map->parts(drawn.ray);
                const V2f error = map->error(StopMap::square(stop));
                const auto apart = [&](size_t a, size_t b) {
                    return std::hypot(traced[a] - double(mapped[int(a)]),
                                      traced[b] - double(mapped[int(b)]));
                };
                // Floats of places and slopes of order 1 are no better.
                const double share = std::max(apart(0, 1) / (double(error.x) + 1e-8),
                                              apart(2, 3) / (double(error.y) + 1e-8));
                worse += share > 1;
                most = std::max(most, share);
            }
        EXPECT_LE(worse, rays / 20) << seen.name << ' ' << seen.focus_m << ": " << worse << " of "
                                    << rays << " are off by more, by up to " << most << " times";
        const bool folds = seen.name == std::string("anamorphic");
        EXPECT_LE(beyond, rays / (folds ? 100 : 750))
            << seen.name << ' ' << seen.focus_m << ": " << beyond << " of " << rays
            << " clear rays are beyond the disc";
        if (!folds) {
            EXPECT_LT(map->error(StopMap::square(V2f(0.f))).y, 1e-3f) << seen.name;
        }
    }
}

TEST(StopMaps, PointsOfTheDiscAreThoseOfTheStop) {
    const auto map = StopMap::of(lens(test::kTakumar), test::cell_about(V2f(0.1f), kStop_px));
    ASSERT_TRUE(map);
    for (const V2f& s : {V2f(0.f), V2f(0.9f, 0.1f), V2f(-0.3f, 0.7f)})
        EXPECT_LT((map->on_disc(map->stop_mm(s)) - s).length(), 1e-5f);
    const V2f x = map->stop_mm(V2f(1, 0)) - map->stop_mm(V2f(0.f)),
              y = map->stop_mm(V2f(0, 1)) - map->stop_mm(V2f(0.f));
    EXPECT_NEAR(std::fabs(x.x * y.y - x.y * y.x), map->stretch_mm2(), 1e-3f);
    EXPECT_LT(map->stretch_mm2(), 0.8 * sqr(stop_reach_mm(lens(test::kTakumar))))
        << "rims leave a cat's eye";
}

}  // namespace
}  // namespace petzval::camera
