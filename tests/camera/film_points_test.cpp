// SPDX-License-Identifier: Apache-2.0
// Film points that a lens camera takes together: what each gets does not depend on the others.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "core/sampling/filter.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/statistics.h"

namespace petzval::camera {
namespace {

using namespace test;

const std::vector<std::string> kLenses = {kTakumar, kFisheye, "canon-14mm-f2.8-asph",
                                          "schneider-anamorphic-31mm"};

template <class T>
bool same_bytes(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

bool same(const CameraSample& a, const CameraSample& b) {
    if (a.size() != b.size() || !same_bytes(a.lanes, b.lanes) || a.exposure != b.exposure)
        return false;
    for (size_t i = 0; i < a.size(); ++i)
        if (!same_bytes(a[i].ray.origin, b[i].ray.origin) ||
            !same_bytes(a[i].ray.direction, b[i].ray.direction) ||
            !same_bytes(a[i].weight, b[i].weight) || !same_bytes(a[i].lanes, b[i].lanes) ||
            a[i].hero_decided != b[i].hero_decided || a[i].to_target != b[i].to_target)
            return false;
    return true;
}

// Film points over the whole film and a little beyond, some with the pixel's filter.
struct Points {
    Filter filter{FilterKind::BlackmanHarris, 1.5f};
    std::vector<FilmPoint> points;
    std::vector<Bands> bands;

    explicit Points(bool spectral, bool filtered = true) {
        test::Random random(5);
        for (uint32_t i = 0; i < 160; ++i) {
            const V2f offset = filter.sample(random.next2());
            FilmPoint at = film_point(random.next2() * 1.04f - V2f(0.02f), i);
            if (filtered) at.pixel = {&filter, offset, {480, 320}};
            points.push_back(at);
            bands.push_back(spectral ? led_by(four_wavelengths(), random.next()) : Bands::rgb());
        }
    }
};

TEST(FilmPoints, TogetherGiveTheBytesOfEachAlone) {
    const Points rgb(false), spectral(true), unfiltered(true, false);
    for (const std::string& name : kLenses)
        for (const DispersionMode mode :
             {DispersionMode::Shared, DispersionMode::Hero, DispersionMode::Split})
            for (const Coating coating : {Coating::Ideal, Coating::MgF2})
                for (const Points* of : {&rgb, &spectral, &unfiltered}) {
                    LensCameraInput in = input_of(name, mode);
                    in.coating = coating;
                    const LensCamera camera(in);
                    size_t passed = 0;
                    for (size_t first = 0, count = 1; first + count <= of->points.size();
                         first += count, count = count % kMostFilmPoints + 1) {
                        const std::span points(&of->points[first], count);
                        const std::span bands(&of->bands[first], count);
                        std::array<CameraSample, kMostFilmPoints> together;
                        camera.sample_all(points, bands, {together.data(), count});
                        for (size_t i = 0; i < count; ++i) {
                            ASSERT_TRUE(same(together[i], camera.sample(points[i], bands[i])))
                                << name << ", mode " << int(mode) << ", point " << first + i;
                            passed += !together[i].empty();
                        }
                    }
                    EXPECT_GT(passed, 40u) << name;
                }
}

// The aimer's table ends in the middle of the film: beyond it a lane takes steps of its own.
TEST(FilmPoints, RaysAreAimedAsIfAlone) {
    for (const std::string& name : kLenses) {
        const LensCameraInput in = input_of(name);
        const Lens& lens = *in.lens;
        const RayAimer aimer(lens, in.film_mm, 7);
        const auto radius =
            float(lens.prescription().surfaces[size_t(lens.stop())].semi_diameter_mm);
        test::Random random(6);
        int slow = 0;
        for (int batch = 0; batch < 200; ++batch) {
            PlanePoint<f8> film(f8{}, f8{}), stop(f8{}, f8{});
            f8 nm;
            for (int i = 0; i < 8; ++i) {
                const V2f at = (random.next2() - V2f(0.5f)) * 24.f;
                const V2f on_stop = uniform_disk(random.next2()) * radius;
                film.x[i] = at.x, film.y[i] = at.y;
                stop.x[i] = on_stop.x, stop.y[i] = on_stop.y;
                nm[i] = 450 + 200 * random.next();
            }
            const FoundRays all = aimer.aim(film, stop, lens.indices(nm), nm);
            for (int i = 0; i < 8; ++i) {
                const f8 one_nm = splat8(nm[i]);
                const FoundRays one = aimer.aim(PlanePoint<f8>(film[i]), PlanePoint<f8>(stop[i]),
                                                lens.indices(one_nm), one_nm);
                ASSERT_EQ(all.found[i], one.found[0]) << name;
                if (!all.found[i]) continue;
                slow += all.traces[i] > all.traces[(i + 1) % 8];
                ASSERT_EQ(all.traces[i], one.traces[0]) << name;
                for (const auto& [a, b] : {std::pair{all.l, one.l}, std::pair{all.m, one.m},
                                           std::pair{all.ray.origin.x, one.ray.origin.x},
                                           std::pair{all.ray.direction.y, one.ray.direction.y},
                                           std::pair{all.stretch_mm2(), one.stretch_mm2()}})
                    ASSERT_EQ(a[i], b[0]) << name;
                ASSERT_EQ(all.clear[i], one.clear[0]) << name;
            }
        }
        EXPECT_GT(slow, 100) << name;
    }
}

// The same rays, solved for in floats, but crossed and landed in doubles, point by point.
TEST(FilmPoints, HeroRaysAgreeWithDoubles) {
    const Points of(true);
    for (const std::string& name : kLenses)
        for (const Coating coating : {Coating::Ideal, Coating::Uncoated}) {
            LensCameraInput in = input_of(name, DispersionMode::Hero);
            in.coating = coating;
            const LensCamera floats(in);
            in.precision = Precision::Double;
            const LensCamera doubles(in);
            int checked = 0;
            for (size_t first = 0; first < of.points.size(); first += kMostFilmPoints) {
                std::array<CameraSample, kMostFilmPoints> a;
                floats.sample_all({&of.points[first], kMostFilmPoints},
                                  {&of.bands[first], kMostFilmPoints}, a);
                for (size_t i = 0; i < kMostFilmPoints; ++i) {
                    const CameraSample b =
                        doubles.sample(of.points[first + i], of.bands[first + i]);
                    if (a[i].empty() || b.empty()) continue;
                    ++checked;
                    const CameraPath &p = a[i][0], &q = b[0];
                    ASSERT_LT((p.ray.direction - q.ray.direction).length(), 2e-5) << name;
                    ASSERT_LT((p.ray.origin - q.ray.origin).length(), 2e-6) << name;
                    for (int k = 0; k < 4; ++k)
                        ASSERT_NEAR(p.weight[k], q.weight[k], 4e-3f * hmax(q.weight)) << name;
                }
            }
            EXPECT_GT(checked, 40) << name;
        }
}

}  // namespace
}  // namespace petzval::camera
