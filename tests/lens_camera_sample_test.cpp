// SPDX-License-Identifier: Apache-2.0
// What the lens camera hands to the integrator: rays in the world, lanes, weights, and what became
// of the lanes that are missing; marches in doubles; coatings.
#include <gtest/gtest.h>

#include <algorithm>

#include "camera/lens_camera.h"
#include "camera/paraxial.h"
#include "camera/traced_ray.h"
#include "tests/support/lens_json.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using test::read_lens;

const std::string kTakumar = "takumar-50mm-f1.2", kGauss = "double-gauss-100mm-f2",
                  kFisheye = "minolta-fisheye-16mm-f2.8";

/// Turned and moved: its camera looks along (0.48, -0.6, -0.64), up is (0.36, 0.8, -0.48).
M44f posed() {
    M44f m;
    const V3f back(-0.48f, 0.6f, 0.64f), up(0.36f, 0.8f, -0.48f), right = up.cross(back);
    const V3f origin(1, 2, 3);
    const V3f rows[] = {right, up, back, origin};
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) m[i][k] = rows[i][k];
    return m;
}

LensCameraInput input_of(const std::string& name, Chroma chroma = Chroma::Split,
                         double stop_scale = 1) {
    const auto lens = std::make_shared<const Lens>(read_lens(name));
    const double radius =
        lens->prescription().surfaces[size_t(lens->stop())].semi_diameter_mm * stop_scale;
    LensCameraInput in{.lens = lens, .iris = Iris(Disk{}, radius), .to_world = posed()};
    in.film_mm = lens->film_mm();
    in.entrance_pupil_mm = first_order(*lens, kLineD_nm).entrance_pupil_mm;
    in.chroma = chroma;
    return in;
}

Bands four_wavelengths() {
    Bands bands = Bands::rgb();
    bands.spectral = true;
    bands.nm = f4{490, 530, 610, 652};
    bands.on = m4{-1, -1, -1, -1};
    return bands;
}

int first_lane(const CameraPath& path) {
    int lane = 0;
    while (lane < 3 && !path.lanes[lane]) ++lane;
    return lane;
}

FilmPoint film_point(V2f film, uint32_t index) {
    return {film, Sampler(SamplerKind::Owen, 7, {0, 0, index})};
}
V2f millimetres(const LensCameraInput& in, V2f film) {
    return {(0.5f - film.x) * float(in.film_width_mm), (film.y - 0.5f) * float(in.film_height_mm)};
}
/// What sample() draws for that point.
template <class V = f4>
LensDraw<V> draw_of(const LensCamera& camera, const LensCameraInput& in, const FilmPoint& at,
                    const Bands& bands) {
    return camera.draw<V>(millimetres(in, at.film), at.sampler.get2(Dim::Lens),
                          at.sampler.get1(Dim::LensLane), bands);
}

// The double Gauss is focused at infinity, where a film point is a direction.
TEST(LensCameraSample, RaysLeaveThePupilTowardsWhatIsSeenThere) {
    const LensCameraInput in = input_of(kGauss, Chroma::Shared, 0.3);
    const LensCamera camera(in);
    const double focal_mm = first_order(*in.lens, kLineD_nm).focal_length_mm;
    const V3f back(-0.48f, 0.6f, 0.64f), up(0.36f, 0.8f, -0.48f), right = up.cross(back);
    for (const V2f& film : {V2f(0.5f, 0.5f), V2f(0.9f, 0.5f), V2f(0.5f, 0.1f), V2f(0.2f, 0.8f)})
        for (uint32_t i = 0; i < 64; ++i) {
            const CameraSample seen = camera.sample(film_point(film, i), Bands::rgb());
            ASSERT_EQ(seen.count, 1);
            const Ray& ray = seen.path[0].ray;
            EXPECT_NEAR(ray.direction.length(), 1, 1e-6);
            // Right on the film is right in the scene; its top is up.
            const float ahead = -ray.direction.dot(back);
            EXPECT_NEAR(ray.direction.dot(right) / ahead, (film.x - 0.5) * 36 / focal_mm, 2e-3);
            EXPECT_NEAR(ray.direction.dot(up) / ahead, (0.5 - film.y) * 24 / focal_mm, 2e-3);
            // In metres, through the entrance pupil, whose middle stands at the pose.
            const V3f from = ray.origin - V3f(1, 2, 3);
            const V3f in_pupil = from - ray.direction * (from.dot(back) / ray.direction.dot(back));
            EXPECT_LT(in_pupil.length(), 0.3 * 0.025 * 1.1);
        }
}

TEST(LensCameraSample, LanesOfPathsPartitionThoseThatPass) {
    const Bands bands = four_wavelengths();
    for (const std::string& name : {kTakumar, kFisheye})
        for (const Chroma chroma : {Chroma::Auto, Chroma::Shared, Chroma::Split, Chroma::Single}) {
            LensCameraInput in = input_of(name, chroma);
            in.tolerance_rad = 5e-5f;
            const LensCamera camera(in);
            test::Random random(3);
            std::array<int, 5> counts{};
            for (uint32_t i = 0; i < 2000; ++i) {
                const FilmPoint at = film_point(random.next2(), i);
                const LensDraw<f4> drawn = draw_of(camera, in, at, bands);
                const CameraSample seen = camera.sample(at, bands);
                ++counts[size_t(seen.count)];
                f4 weight{};
                m4 lanes{};
                for (int k = 0; k < seen.count; ++k) {
                    const CameraPath& path = seen.path[size_t(k)];
                    ASSERT_GT(lane_count(path.lanes), 0);
                    ASSERT_EQ(lane_count(path.lanes & lanes), 0);
                    lanes |= path.lanes;
                    weight += path.weight;
                }
                const m4 passed = drawn.weight > 0.f;
                for (int lane = 0; lane < 4; ++lane) {
                    ASSERT_EQ(lanes[lane], passed[lane]);
                    ASSERT_EQ(weight[lane], drawn.weight[lane]);
                }
                if (chroma == Chroma::Split) {
                    ASSERT_EQ(seen.count, lane_count(passed));
                }
                if (chroma == Chroma::Single) {
                    ASSERT_LE(lane_count(lanes), 1);
                }
            }
            EXPECT_EQ(counts[1] + counts[0] == 2000,
                      chroma == Chroma::Shared || chroma == Chroma::Single);
            if (chroma == Chroma::Split) {
                EXPECT_GT(counts[4], 1000) << name;
            }
            if (chroma == Chroma::Auto) {
                EXPECT_GT(
                    std::min(counts[1] + counts[2] + counts[3], counts[2] + counts[3] + counts[4]),
                    100)
                    << name;
            }
        }
}

TEST(LensCameraSample, OneWavelengthAPathIsAllInTheMean) {
    const Bands bands = four_wavelengths();
    const auto mean = [&](Chroma chroma) {
        const LensCamera camera(input_of(kTakumar, chroma, 0.5));
        std::array<test::Moments, 4> out;
        for (uint32_t i = 0; i < 1 << 14; ++i) {
            const CameraSample seen = camera.sample(film_point({0.8f, 0.3f}, i), bands);
            f4 weight{};
            for (int k = 0; k < seen.count; ++k) weight += seen.path[size_t(k)].weight;
            for (size_t lane = 0; lane < 4; ++lane) out[lane].add(weight[int(lane)]);
        }
        return out;
    };
    const auto single = mean(Chroma::Single), split = mean(Chroma::Split);
    // Owen's points are better than independent ones, so that the errors are overestimates.
    for (size_t lane = 0; lane < 4; ++lane) {
        const double error =
            std::hypot(single[lane].standard_error(), split[lane].standard_error());
        EXPECT_LT(error, 0.03 * split[lane].mean());
        EXPECT_GE(test::two_sided_p((single[lane].mean() - split[lane].mean()) / error),
                  test::sidak());
    }
}

TEST(LensCameraSample, GainIsInTheWeight) {
    const LensCameraInput in = input_of(kGauss, Chroma::Shared);
    LensCamera camera(in);
    const FilmPoint at = film_point({0.5f, 0.5f}, 1);
    const float before = camera.sample(at, Bands::rgb()).path[0].weight[0];
    camera.set_exposure(2, 1);
    EXPECT_FLOAT_EQ(camera.sample(at, Bands::rgb()).path[0].weight[0], 2 * before);
}

// Lanes share a ray where they meet the plane of focus within the tolerance: on a close one it
// matters how far the lens's front stands before its pupil. Rays that lead backwards meet no plane,
// and none are shared.
TEST(LensCameraSample, AutoSharesWhatMeetsOnThePlaneOfFocus) {
    const V3f eye(1, 2, 3), ahead(0.48f, -0.6f, -0.64f);
    const Bands bands = four_wavelengths();
    for (const auto& [name, side_mm] : {std::pair{kTakumar, 24.}, {kFisheye, 38.}}) {
        LensCameraInput in = input_of(name);
        in.film_width_mm = in.film_height_mm = side_mm;
        in.focus_m = 0.15f;
        in.tolerance_rad = 3e-4f;
        const LensCamera split(in);
        in.chroma = Chroma::Auto;
        const LensCamera automatic(in);
        test::Random random(8);
        int shared = 0, parted = 0, backwards = 0;
        for (uint32_t i = 0; i < 20000; ++i) {
            const FilmPoint at = film_point(random.next2(), i);
            const CameraSample a = split.sample(at, bands), b = automatic.sample(at, bands);
            if (a.count < 2) continue;
            const Ray &first = a.path[0].ray, &second = a.path[1].ray;
            const bool together = b.path[0].lanes[first_lane(a.path[1])] != 0;
            const float cosine1 = first.direction.dot(ahead), cosine2 = second.direction.dot(ahead);
            if (cosine1 <= 0 || cosine2 <= 0) {
                ++backwards;
                ASSERT_FALSE(together);
                continue;
            }
            const auto on_plane = [&](const Ray& ray, float cosine) {
                return ray.origin +
                       ray.direction * ((in.focus_m - (ray.origin - eye).dot(ahead)) / cosine);
            };
            const float apart =
                (on_plane(first, cosine1) - on_plane(second, cosine2)).length() / in.focus_m;
            if (std::fabs(apart / in.tolerance_rad - 1) < 0.02f) continue;  // rounding
            ASSERT_EQ(together, apart < in.tolerance_rad) << name << ' ' << apart;
            ++(together ? shared : parted);
        }
        EXPECT_GT(shared, 100) << name;
        EXPECT_GT(parted, 100) << name;
        if (name == kFisheye) {
            EXPECT_GT(backwards, 20);
        }
    }
}

// Where the fisheye's image ends: rims take rays first; beyond a field of 90 degrees rays graze the
// front surface, then are totally reflected within it, before the film point sees no stop at all.
TEST(LaneFates, AtTheFisheyesRimRaysGrazeThenAreTotallyReflected) {
    const LensCameraInput in = input_of(kFisheye, Chroma::Shared);
    LensCameraInput bare = in;
    bare.coating = Coating::Uncoated;
    const LensCamera camera(in), uncoated(bare);
    const double radius_mm = 1 / in.lens->prescription().surfaces.front().curvature_1_mm;
    struct Rim {
        LaneFates<uint64_t> lanes;
        double least_ahead = 1, least_cosine = 1, least_transmitted = 1;
    };
    const auto at = [&](float height_mm) {
        Rim rim;
        test::Random random(6);
        for (int i = 0; i < 4000; ++i) {
            const V2f u = random.next2(), film(0, height_mm);
            const auto drawn = camera.draw<f4>(film, u, 0, Bands::rgb());
            const auto lossy = uncoated.draw<f4>(film, u, 0, Bands::rgb());
            rim.lanes += drawn.lanes;
            const double weight = double(drawn.weight[0]);
            EXPECT_EQ(weight > 0, drawn.lanes.lost() == 0);
            if (!(weight > 0)) continue;
            const auto &o = drawn.ray.origin, &d = drawn.ray.direction;
            const V3d from_centre(o.x[0], o.y[0], double(o.z[0]) - radius_mm);
            const double cosine = from_centre.dot(V3d(d.x[0], d.y[0], d.z[0])) / radius_mm;
            const double transmitted = double(lossy.weight[0]) / weight;
            EXPECT_GE(transmitted, 0);
            EXPECT_LT(transmitted, 1);
            rim.least_ahead = std::min(rim.least_ahead, -double(d.z[0]));
            if (cosine < rim.least_cosine) {
                rim.least_cosine = cosine;
                rim.least_transmitted = transmitted;
            }
        }
        return rim;
    };
    for (const float height_mm : {18.f, 21.6f, 22.f}) {
        const Rim rim = at(height_mm);
        EXPECT_GT(rim.lanes.vignetted, rim.lanes.drawn / 50);
        EXPECT_EQ(rim.lanes.lost(), rim.lanes.vignetted) << height_mm;
        EXPECT_GT(rim.least_transmitted, 0.25) << height_mm;
        EXPECT_EQ(rim.least_ahead<0, height_mm> 21.8f) << height_mm;
    }
    const Rim last = at(23);
    EXPECT_LT(last.least_ahead, -0.25);  // 15 degrees beyond a right angle
    EXPECT_LT(last.least_cosine, 0.01);
    EXPECT_LT(last.least_transmitted, 0.02);
    EXPECT_GT(last.lanes.totally_reflected, last.lanes.drawn / 10);
    EXPECT_LT(last.lanes.lost(), last.lanes.drawn);
    for (const float height_mm : {24.f, 25.f, 28.f}) {
        const LaneFates<uint64_t> dark = at(height_mm).lanes;
        EXPECT_EQ(dark.lost(), dark.drawn) << height_mm;
        EXPECT_EQ(dark.totally_reflected > 0, height_mm < 26) << height_mm;
        EXPECT_EQ(dark.unreached > 0, height_mm > 26) << height_mm;
        EXPECT_EQ(dark.missed, 0u);
    }
}

/// Of many samples over a film. Every sample's lanes must add up.
LaneFates<uint64_t> fates(const LensCameraInput& in, const Bands& bands) {
    const LensCamera camera(in);
    LaneFates<uint64_t> out;
    test::Random random(6);
    for (uint32_t i = 0; i < 4000; ++i) {
        const CameraSample seen = camera.sample(film_point(random.next2(), i), bands);
        uint32_t passed = 0;
        for (int k = 0; k < seen.count; ++k)
            passed += uint32_t(lane_count(seen.path[size_t(k)].lanes));
        EXPECT_EQ(seen.lanes.drawn, in.chroma == Chroma::Single ? 1 : lane_count(bands.on));
        EXPECT_EQ(passed + seen.lanes.lost(), seen.lanes.drawn);
        out += seen.lanes;
    }
    return out;
}

TEST(LaneFates, AddUpAndTellTheCause) {
    for (const Chroma chroma : {Chroma::Shared, Chroma::Split, Chroma::Single})
        for (const March precision : {March::Float, March::Double}) {
            LensCameraInput in = input_of(kTakumar, chroma);
            in.march = precision;
            const auto open = fates(in, four_wavelengths());
            EXPECT_GT(open.vignetted, open.drawn / 10);  // cat's eyes
            EXPECT_LT(open.vignetted, open.drawn / 2);
            // A small stop lets everything through.
            LensCameraInput small = input_of(kTakumar, chroma, 0.2);
            small.march = precision;
            const auto stopped = fates(small, four_wavelengths());
            EXPECT_LT(stopped.lost(), stopped.drawn / 100);  // edges of the iris, between lanes
        }
}

TEST(LaneFates, AFilmBeyondTheImageCircleIsBlack) {
    LensCameraInput in = input_of(kGauss, Chroma::Shared);
    in.film_width_mm = in.film_height_mm = 300;
    const auto all = fates(in, Bands::rgb());
    EXPECT_GT(all.vignetted, 0u);
    EXPECT_GT(all.unreached, all.drawn / 4);
    EXPECT_GT(all.lost(), all.drawn * 9 / 10);
}

// An iris that is larger than the stop is cut off by its rim; of a wide one, no ray gets anywhere.
TEST(LaneFates, AWideIrisIsVignettedOrUnreached) {
    const auto some = fates(input_of(kGauss, Chroma::Shared, 1.5), Bands::rgb());
    EXPECT_GT(some.vignetted, some.drawn / 2);
    const auto most = fates(input_of(kGauss, Chroma::Shared, 20), Bands::rgb());
    EXPECT_GT(most.unreached, most.drawn / 2);
}

// Plane glass before the stop, steep rays within: they meet the next plane beyond the critical
// angle, or a ball that they miss.
TEST(LaneFates, TotalReflectionAndMissesAreToldApart) {
    const auto through = [](double last_curvature, double glass) {
        Prescription p;
        const auto add = [&p](double curvature, double thickness, double index, bool stop) {
            LensSurface s;
            s.curvature_1_mm = curvature;
            s.thickness_mm = thickness;
            s.semi_diameter_mm = 1000;
            s.stop = stop;
            if (index != 1) s.glass = Glass{"as given", IndexTable{{{400, index}, {700, index}}}};
            p.surfaces.push_back(std::move(s));
        };
        add(last_curvature, 5, glass, false);
        add(0, 5, glass == 1 ? 1.5 : 1, true);
        add(0, 10, 1, false);
        const auto lens = std::make_shared<const Lens>(p);
        LensCameraInput in{.lens = lens, .iris = Iris(Disk{}, 15), .to_world = M44f()};
        in.film_mm = lens->film_mm();
        in.film_width_mm = in.film_height_mm = 2;
        in.chroma = Chroma::Shared;
        return fates(in, Bands::rgb());
    };
    const auto curved = through(0.1, 1.8);  // light leaves the glass through a ball of 10 mm
    EXPECT_GT(curved.missed, 0u);
    EXPECT_EQ(curved.vignetted, 0u);
    const auto concave = through(-0.04, 1.8);
    EXPECT_GT(concave.totally_reflected, 0u);
    EXPECT_EQ(concave.vignetted, 0u);
}

TEST(LensCameraMarch, DoublesAgreeWithFloats) {
    const Bands bands = four_wavelengths();
    for (const std::string& name : {kTakumar, kFisheye, std::string("canon-14mm-f2.8-asph")}) {
        LensCameraInput in = input_of(name);
        const LensCamera floats(in);
        in.march = March::Double;
        const LensCamera camera(in);
        test::Random random(2);
        int checked = 0;
        for (uint32_t i = 0; i < 1000; ++i) {
            const FilmPoint at = film_point(random.next2(), i);
            const CameraSample a = floats.sample(at, bands), b = camera.sample(at, bands);
            if (a.count != 4 || b.count != 4) continue;
            ++checked;
            for (size_t k = 0; k < 4; ++k) {
                ASSERT_LT((a.path[k].ray.direction - b.path[k].ray.direction).length(), 2e-5);
                ASSERT_LT((a.path[k].ray.origin - b.path[k].ray.origin).length(), 2e-6) << name;
                ASSERT_NEAR(a.path[k].weight[int(k)], b.path[k].weight[int(k)],
                            1e-3f * a.path[k].weight[int(k)]);
            }
        }
        EXPECT_GT(checked, 300) << name;
    }
}

// Backwards through the whole lens with trace_ray, which gives the direction at the film; from
// there central differences of trace_ray say how far the iris point moves.
TEST(LensCameraMarch, DoublesAreATracedRays) {
    const Bands bands = four_wavelengths();
    for (const std::string& name : {kTakumar, kFisheye, std::string("canon-14mm-f2.8-asph"),
                                    std::string("schneider-anamorphic-31mm")}) {
        const LensCameraInput in = input_of(name, Chroma::Split, 0.9);
        const Lens& lens = *in.lens;
        const LensCamera camera(in);
        test::Random random(2);
        int checked = 0;
        for (uint32_t i = 0; i < 200; ++i) {
            const V2f film = (random.next2() - V2f(0.5f)) * 16.f, u = random.next2();
            const auto drawn = camera.draw<d4>(film, u, random.next(), bands);
            if (!all(drawn.weight > 0)) continue;
            ++checked;
            double stretches = 0;
            for (int lane = 0; lane < 4; ++lane) {
                const auto vector = [lane](const Vec3<d4>& v) {
                    return V3d(v.x[lane], v.y[lane], v.z[lane]);
                };
                const double nm = bands.nm[lane];
                const V3d origin =
                    vector(drawn.ray.origin) + V3d(0, 0, lens.vertex_mm(drawn.ray.counted_from));
                const TracedRay back = trace_ray(lens, origin, -vector(drawn.ray.direction), nm,
                                                 Towards::Film, Clip::Yes);
                ASSERT_EQ(back.fate, Fate::Passed) << name;
                const auto met = back.at_plane(in.film_mm);
                ASSERT_TRUE(met);
                ASSERT_NEAR((*met)[0], film.x, 1e-9) << name;
                ASSERT_NEAR((*met)[1], film.y, 1e-9) << name;
                const auto at_stop = [&](double dl, double dm) {
                    V3d d = -back.direction + V3d(dl, dm, 0);
                    d.z = -std::sqrt(1 - d.x * d.x - d.y * d.y);
                    return trace_ray(lens, {film.x, film.y, in.film_mm}, d, nm, Towards::Scene,
                                     Clip::No)
                        .points[size_t(lens.last() - lens.stop())];
                };
                constexpr double kStep = 1e-5;
                const V3d by_l = (at_stop(kStep, 0) - at_stop(-kStep, 0)) / (2 * kStep);
                const V3d by_m = (at_stop(0, kStep) - at_stop(0, -kStep)) / (2 * kStep);
                stretches += std::fabs(by_l.x * by_m.y - by_l.y * by_m.x);
            }
            const double expected = in.iris.area_mm2() / (stretches / 4);
            for (int lane = 0; lane < 4; ++lane)
                ASSERT_NEAR(drawn.weight[lane] / expected, 1, 1e-6) << name;
        }
        EXPECT_GT(checked, 60) << name;
    }
}

TEST(LensCameraCoating, LossesMultiplyTheWeight) {
    for (const std::string& name : {kGauss, kFisheye})
        for (const Coating coating : {Coating::Uncoated, Coating::MgF2}) {
            LensCameraInput in = input_of(name, Chroma::Split, 0.05);
            const LensCamera ideal(in);
            in.coating = coating;
            const LensCamera camera(in);
            const Bands bands = four_wavelengths();
            // A small stop on the axis: nearly normal incidence.
            const FilmPoint at = film_point({0.5f, 0.5f}, 3);
            const auto bare = draw_of(ideal, in, at, bands), lossy = draw_of(camera, in, at, bands);
            const auto precise = draw_of<d4>(camera, in, at, bands);
            for (int lane = 0; lane < 4; ++lane) {
                const float through = lossy.weight[lane] / bare.weight[lane];
                EXPECT_NEAR(through, axial_transmittance(*in.lens, coating, bands.nm[lane]), 1e-3);
                EXPECT_NEAR(through, precise.weight[lane] / bare.weight[lane], 1e-4);
            }
            EXPECT_EQ(camera.irradiance(V2f(0.f), 64), ideal.irradiance(V2f(0.f), 64));
        }
}

// Surface by surface, with angles from the points of trace_ray.
TEST(LensCameraCoating, OffTheAxisEachSurfaceHasItsAngle) {
    LensCameraInput in = input_of(kGauss, Chroma::Split);
    const LensCamera ideal(in);
    in.coating = Coating::Uncoated;
    const LensCamera camera(in);
    const Lens& lens = *in.lens;
    const Bands bands = four_wavelengths();
    for (uint32_t i = 0; i < 40; ++i) {
        const FilmPoint at = film_point({0.75f, 0.4f}, i);
        const auto bare = draw_of<d4>(ideal, in, at, bands),
                   lossy = draw_of<d4>(camera, in, at, bands);
        if (!all(bare.weight > 0)) continue;
        const V2f film = millimetres(in, at.film);
        for (int lane = 0; lane < 4; ++lane) {
            const double nm = bands.nm[lane];
            const auto& o = bare.ray.origin;
            const auto& d = bare.ray.direction;
            const V3d origin(o.x[lane], o.y[lane],
                             o.z[lane] + lens.vertex_mm(bare.ray.counted_from));
            const V3d away(d.x[lane], d.y[lane], d.z[lane]);
            TracedRay back = trace_ray(lens, origin, -away, nm, Towards::Film, Clip::No);
            std::vector<V3d> points{origin + away};
            points.insert(points.end(), back.points.begin(), back.points.end());
            points.emplace_back(film.x, film.y, in.film_mm);
            const auto indices = lens.exact_indices(d4{} + nm);
            double through = 1;
            for (int k = 0; k < lens.size(); ++k) {
                const auto& s = lens.surfaces<double>()[size_t(k)];
                if (s.medium_before == s.medium_after) continue;
                const V3d& p = points[size_t(k) + 1];
                V3d normal(-s.curvature_x * p.x, -s.curvature_y * p.y,
                           1 - s.curvature_z * (p.z - lens.vertex_mm(k)));
                normal.normalize();
                const auto cosine = [&](const V3d& step) { return normal.dot(step.normalized()); };
                const double c0 = cosine(p - points[size_t(k)]);
                const double c1 = cosine(points[size_t(k) + 2] - p);
                const double n0 = indices.of_medium[s.medium_before][0],
                             n1 = indices.of_medium[s.medium_after][0];
                const double rs = (n0 * c0 - n1 * c1) / (n0 * c0 + n1 * c1);
                const double rp = (n1 * c0 - n0 * c1) / (n1 * c0 + n0 * c1);
                through *= 1 - (rs * rs + rp * rp) / 2;
            }
            ASSERT_NEAR(lossy.weight[lane] / bare.weight[lane], through, 1e-5);
        }
    }
}

}  // namespace
}  // namespace petzval
