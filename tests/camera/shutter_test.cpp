// SPDX-License-Identifier: Apache-2.0
// Times of a shutter against the light that its curve lets in, and the places of a moving camera.
#include "camera/shutter.h"

#include "camera/models/thin_lens.h"
#include "tests/support/chi_square.h"

namespace petzval::camera {
namespace {

using test::Random;
using Curves = std::vector<std::pair<const char*, ShutterCurve>>;

/// Every kind of curve that a file may hold.
Curves curves() {
    return {
        {"box", ShutterCurve::box()},
        {"trapezoid", ShutterCurve::trapezoid()},
        {"triangle", {{{0, 0}, {0.5f, 1}, {1, 0}}}},
        {"rises", {{{0, 0}, {1, 2}}}},
        {"falls", {{{0, 3}, {1, 0}}}},
        {"closed at both ends", {{{0, 0}, {0.3f, 0}, {0.4f, 1}, {0.6f, 1}, {0.7f, 0}, {1, 0}}}},
        {"closed in the middle", {{{0, 1}, {0.4f, 1}, {0.4f, 0}, {0.6f, 0}, {0.6f, 1}, {1, 1}}}},
        {"jumps", {{{0, 0.25f}, {0.5f, 0.25f}, {0.5f, 1}, {0.75f, 0.5f}, {0.75f, 0}, {1, 2}}}},
        {"three points at one time", {{{0, 0}, {0.5f, 1}, {0.5f, 9}, {0.5f, 0.5f}, {1, 0}}}},
        {"jumps at the ends", {{{0, 5}, {0, 1}, {1, 1}, {1, 7}}}},
        {"nearly even", {{{0, 1}, {1, 1.000001f}}}},
        {"bright", {{{0, 0}, {0.5f, 1e6f}, {1, 0}}}},
        {"dim", {{{0, 0}, {0.5f, 1e-25f}, {1, 0}}}},
        {"a flash", {{{0, 0.01f}, {0.499f, 0.01f}, {0.5f, 100}, {0.501f, 0.01f}, {1, 0.01f}}}}};
}

/// Light up to a time, over all: sums of thin strips within each piece of the curve.
double light_before(const ShutterCurve& curve, double time) {
    constexpr int kStrips = 50;
    double sum = 0, whole = 0;
    for (size_t i = 1; i < curve.points.size(); ++i) {
        const auto &a = curve.points[i - 1], &b = curve.points[i];
        const double length = double(b.time) - double(a.time);
        if (!(length > 0)) continue;
        const auto open = [&](double s) { return double(a.open) * (1 - s) + double(b.open) * s; };
        const double end = std::clamp((time - double(a.time)) / length, 0., 1.);
        for (int k = 0; k < kStrips; ++k) {
            sum += open(end * (k + 0.5) / kStrips) * end * length / kStrips;
            whole += open((k + 0.5) / kStrips) * length / kStrips;
        }
    }
    return sum / whole;
}

/// The time by which a share of the light has come, by halving.
double time_of_light(const ShutterCurve& curve, double share) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (light_before(curve, middle) < share ? low : high) = middle;
    }
    return low;
}

/// Openness just before and just after a time, the greater of both.
double openness(const ShutterCurve& curve, double time) {
    double most = 0;
    for (size_t i = 1; i < curve.points.size(); ++i) {
        const auto &a = curve.points[i - 1], &b = curve.points[i];
        if (time < double(a.time) || time > double(b.time) || a.time == b.time) continue;
        const double s = (time - double(a.time)) / (double(b.time) - double(a.time));
        most = std::max(most, double(a.open) * (1 - s) + double(b.open) * s);
    }
    return most;
}

TEST(Shutter, TimesFollowTheLightThatTheCurveLetsIn) {
    for (const auto& [name, curve] : curves()) {
        const Shutter shutter(curve, {}, M44f());
        Random random(1);
        for (int i = 0; i < 1000; ++i) {
            const float u = random.next();
            const float time = shutter.time(u);
            ASSERT_TRUE(time >= 0.f && time < 1.f) << name << ' ' << u << ' ' << time;
            // Floats tell times apart to 6e-8, and a flash is 900 times as bright as the mean.
            ASSERT_NEAR(light_before(curve, double(time)), double(u), 6e-5) << name;
            // Where it is open, the light tells the time.
            const double expected = time_of_light(curve, double(u)), bound = 1e-3;
            if (openness(curve, expected) > 0.1 * openness(curve, 0.5)) {
                ASSERT_NEAR(double(time), expected, bound) << name << ' ' << u;
            }
        }
    }
}

TEST(Shutter, TimesFallIntoEqualPartsInProportionToTheOpenness) {
    uint32_t seed = 1;
    for (const auto& [name, curve] : curves()) {
        constexpr int kParts = 40, kDraws = 20000;
        const Shutter shutter(curve, {}, M44f());
        std::vector<double> observed(kParts), expected(kParts);
        for (int i = 0; i < kParts; ++i)
            expected[size_t(i)] = kDraws * (light_before(curve, (i + 1.) / kParts) -
                                            light_before(curve, double(i) / kParts));
        Random random(seed++);
        for (int i = 0; i < kDraws; ++i)
            ++observed[static_cast<size_t>(shutter.time(random.next()) * kParts)];
        EXPECT_TRUE(test::chi_square(observed, expected)) << name;
    }
}

// The first and the last number that a sampler gives, and those beside a point of the curve.
TEST(Shutter, TimesAreNumbersAndRiseFromTheFirstToTheLast) {
    for (const auto& [name, curve] : curves()) {
        const Shutter shutter(curve, {}, M44f());
        float last = 0.f;
        const float least = std::numeric_limits<float>::denorm_min();
        std::vector<float> numbers{0.f, least, 1e-38f, 1e-30f, 1e-20f, 0x1p-24f, 0x1p-23f};
        for (int i = 1; i < 1024; ++i) {
            const float u = float(i) / 1024;
            numbers.insert(numbers.end(), {neighbour(u, false), u, neighbour(u, true)});
        }
        numbers.push_back(kOneMinus);
        for (const float u : numbers) {
            const float time = shutter.time(u);
            ASSERT_TRUE(time >= 0.f && time < 1.f) << name << ' ' << u << ' ' << time;
            ASSERT_GE(time, last - 2e-7f) << name << ' ' << u;
            last = std::max(last, time);
        }
        EXPECT_LE(shutter.time(0.f), 1e-3f + time_of_light(curve, 1e-9)) << name;
        EXPECT_GE(shutter.time(kOneMinus), time_of_light(curve, 1 - 1e-6) - 1e-3) << name;
    }
}

TEST(Shutter, NoTimeIsDrawnWhileItIsClosed) {
    const ShutterCurve curve{{{0, 0},
                              {0.1f, 0},
                              {0.1f, 1},
                              {0.3f, 1},
                              {0.3f, 0},
                              {0.7f, 0},
                              {0.8f, 1},
                              {0.9f, 0},
                              {1, 0}}};
    const Shutter shutter(curve, {}, M44f());
    for (int i = 0; i < 4096; ++i) {
        const float time = shutter.time(float(i) / 4096);
        EXPECT_TRUE((time >= 0.1f && time <= 0.3f) || (time >= 0.7f && time <= 0.9f)) << time;
    }
}

TEST(Shutter, EfficiencyIsTheAreaOverThePeak) {
    EXPECT_FLOAT_EQ(ShutterCurve::box().efficiency(), 1.f);
    EXPECT_FLOAT_EQ(ShutterCurve::trapezoid().efficiency(), 0.75f);
    EXPECT_FLOAT_EQ((ShutterCurve{{{0, 0}, {0.5f, 1}, {1, 0}}}.efficiency()), 0.5f);
    EXPECT_FLOAT_EQ((ShutterCurve{{{0, 0}, {0.2f, 8}, {1, 0}}}.efficiency()), 0.5f);
    EXPECT_FLOAT_EQ((ShutterCurve{{{0, 2}, {0.5f, 2}, {0.5f, 0}, {1, 0}}}.efficiency()), 0.5f);
    EXPECT_FLOAT_EQ((ShutterCurve{{{0, 1}, {0.5f, 1}, {0.5f, 4}, {1, 4}}}.efficiency()), 0.625f);
}

M44f turned(const V3f& angles, const V3f& place) {
    M44f m;
    m.setEulerAngles(angles);
    for (int k = 0; k < 3; ++k) m[3][k] = place[k];
    return m;
}

/// Places of a camera that turns and flies.
std::vector<M44f> flight(size_t steps) {
    std::vector<M44f> out;
    for (size_t i = 0; i < steps; ++i) {
        const float s = float(i) / float(steps - 1);
        out.push_back(turned(V3f(0.3f * s, 0.8f * s - 0.1f, -0.2f * s), V3f(2 * s, s * s, -3 * s)));
    }
    return out;
}

ThinLensCamera pinhole(const M44f& to_world) {
    ThinLens lens;
    lens.to_world = to_world;
    return ThinLensCamera(lens);
}

// The rays of a camera that stands there.
TEST(Shutter, RaysAreThoseOfACameraThatStandsAtTheStep) {
    const std::vector<M44f> places = flight(5);
    const M44f middle = places[2];
    const Shutter shutter(ShutterCurve::box(), places, middle);
    const Bands bands = Bands::rgb();
    for (size_t i = 0; i < places.size(); ++i) {
        const ThinLensCamera still = pinhole(places[i]), moving = pinhole(middle);
        for (const V2f& film : {V2f(0.1f, 0.2f), V2f(0.5f, 0.5f), V2f(0.9f, 0.7f)}) {
            const Ray expected = still.sample({film}, bands)[0].ray;
            Ray ray = moving.sample({film}, bands)[0].ray;
            ray.time = float(i) / 4;
            shutter.move(ray);
            EXPECT_LT((ray.origin - expected.origin).length(), 2e-6f) << i;
            EXPECT_LT((ray.direction - expected.direction).length(), 1e-6f) << i;
            EXPECT_EQ(ray.time, float(i) / 4);
        }
    }
}

TEST(Shutter, BetweenStepsRaysAreNearThoseOfACameraThatStandsThere) {
    const std::vector<M44f> places = flight(33), fine = flight(33 * 8 - 7);
    const Shutter shutter(ShutterCurve::box(), places, places[16]);
    const Bands bands = Bands::rgb();
    const ThinLensCamera moving = pinhole(places[16]);
    for (size_t i = 0; i < fine.size(); ++i) {
        const Ray expected = pinhole(fine[i]).sample({V2f(0.8f, 0.1f)}, bands)[0].ray;
        Ray ray = moving.sample({V2f(0.8f, 0.1f)}, bands)[0].ray;
        ray.time = float(i) / float(fine.size() - 1);
        shutter.move(ray);
        // A step turns by 0.026 rad; its arc is off its chord by the square of that over 8.
        EXPECT_LT((ray.origin - expected.origin).length(), 3e-4f) << i;
        EXPECT_LT((ray.direction - expected.direction).length(), 1.5e-4f) << i;
        EXPECT_NEAR(ray.direction.length(), 1.f, 1e-6f);
    }
}

TEST(Shutter, ACameraThatStandsStillKeepsItsRaysToTheBit) {
    const Shutter shutter(ShutterCurve::trapezoid(), {}, turned(V3f(1, 2, 3), V3f(4, 5, 6)));
    Ray ray;
    ray.origin = V3f(0.1f, 0.2f, 0.3f);
    ray.direction = unit(V3f(1, -2, 3));
    ray.t_max = 7;
    ray.alpha_seed = 9;
    ray.time = 0.3f;
    const Ray before = ray;
    shutter.move(ray);
    EXPECT_EQ(ray.origin, before.origin);
    EXPECT_EQ(ray.direction, before.direction);
    EXPECT_EQ(ray.t_max, before.t_max);
    EXPECT_EQ(ray.alpha_seed, before.alpha_seed);
    EXPECT_EQ(ray.time, before.time);
}

TEST(Shutter, TimesBeyondTheExposureMoveTheCameraNoFarther) {
    const std::vector<M44f> places = flight(2);
    const Shutter shutter(ShutterCurve::box(), places, places[0]);
    for (const auto& [time, end] : {std::pair(-1.f, 0.f), std::pair(2.f, 1.f)}) {
        Ray beyond, at_end;
        beyond.origin = at_end.origin = V3f(1, 2, 3);
        beyond.direction = at_end.direction = V3f(0, 0, -1);
        beyond.time = time;
        at_end.time = end;
        shutter.move(beyond);
        shutter.move(at_end);
        EXPECT_EQ(beyond.origin, at_end.origin);
        EXPECT_EQ(beyond.direction, at_end.direction);
    }
}

}  // namespace
}  // namespace petzval::camera
