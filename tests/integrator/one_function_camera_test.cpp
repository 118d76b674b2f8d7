// SPDX-License-Identifier: Apache-2.0
// A camera is one function: which rays bring the light of a film point. What aims or moves its rays
// is put around it.
#include <gtest/gtest.h>

#include <numbers>

#include "camera/models/moving_camera.h"
#include "integrator/render/executor.h"
#include "integrator/render/render.h"
#include "tests/support/scenes.h"
#include "tests/support/traced_world.h"

namespace petzval::integrator {
namespace {

/// Equidistant fisheye at the origin: the angle from the axis, -z, grows with the distance from the
/// middle of the film, 180 degrees at its edge.
class Fisheye final : public camera::Camera {
  public:
    [[nodiscard]] camera::CameraSample sample(const camera::FilmPoint& at,
                                              const Bands& bands) const override {
        camera::CameraSample out;
        const V2f from_middle(2 * at.film.x - 1, 1 - 2 * at.film.y);
        const float radius = from_middle.length();
        if (!(radius > 0 && radius < 1)) return out;
        const float angle = kPi * radius;
        camera::CameraPath& path = out.add();
        path.ray.direction = V3f(from_middle.x / radius * std::sin(angle),
                                 from_middle.y / radius * std::sin(angle), -std::cos(angle));
        path.weight = uniform(1.f, bands);
        path.lanes = bands.on;
        return out;
    }
};

constexpr int kSize_px = 64;

/// Brightness of each pixel, row by row, of a lamp in the direction +x that is 2 x 20 degrees wide.
std::vector<float> camera_picture(const camera::Camera& camera) {
    test::TracedWorld world;
    test::place(world.scene,
                test::sphere(V3f(10, 0, 0), 10 * std::sin(std::numbers::pi_v<float> / 9), 64, true),
                test::emitter_material(1));
    world.finish();
    RenderJob job;
    job.end_sample = 16;
    job.filter = Filter(FilterKind::Box, 0.5f);
    Film film({kSize_px, kSize_px}, {0, 0, kSize_px, kSize_px}, {});
    ThreadExecutor executor(1);
    RenderMonitor monitor;
    (void)render(*world.tracer, camera, job, film, executor, monitor);
    std::vector<float> out;
    for (int y = 0; y < kSize_px; ++y)
        for (int x = 0; x < kSize_px; ++x) out.push_back(film.colour(x, y)[1]);
    return out;
}

/// Of the lamp's picture, the share of the film's area, and where its middle is.
struct Seen {
    double share = 0;
    V2d middle{0.};
};
Seen seen_through(const std::vector<float>& pixels) {
    Seen out;
    for (size_t i = 0; i < pixels.size(); ++i) {
        const V2d film((double(i % kSize_px) + 0.5) / kSize_px,
                       (double(i / kSize_px) + 0.5) / kSize_px);
        out.share += double(pixels[i]);
        out.middle += film * double(pixels[i]);
    }
    out.middle /= out.share;
    out.share /= sqr(double(kSize_px));
    return out;
}

// The film's solid angle is pi^2 r sin(pi r) dr dphi / r: a lamp of half-angle a at 90 degrees from
// the axis takes the area that the integral below gives.
double share_due() {
    const double a = std::numbers::pi / 9;
    double area = 0;
    constexpr int kSteps = 20'000;
    for (int i = 0; i < kSteps; ++i) {
        const double from_axis = std::numbers::pi / 2 + a * (2 * (i + 0.5) / kSteps - 1);
        const double half_width = std::acos(std::cos(a) / std::sin(from_axis));
        area += 2 * half_width * from_axis / sqr(std::numbers::pi) * (2 * a / kSteps);
    }
    return area / 4;
}

TEST(OneFunctionCamera, IsEnoughForAPicture) {
    const Seen seen = seen_through(camera_picture(Fisheye()));
    EXPECT_NEAR(seen.share, share_due(), 0.01 * share_due());
    EXPECT_NEAR(seen.middle.x, 0.75, 0.01);
    EXPECT_NEAR(seen.middle.y, 0.5, 0.002);
}

// Turned about its axis by a quarter, as a camera that does so while the shutter is open: the lamp
// is where a still camera of that pose sees it.
TEST(OneFunctionCamera, IsMovedFromOutside) {
    const M44f still, quarter(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    const std::array steps{quarter, quarter};
    const camera::MovingCamera camera(
        std::make_shared<Fisheye>(),
        std::make_shared<camera::Shutter>(camera::ShutterCurve::box(), steps, still));
    const Seen seen = seen_through(camera_picture(camera));
    EXPECT_NEAR(seen.share, share_due(), 0.01 * share_due());
    EXPECT_NEAR(seen.middle.x, 0.5, 0.002);
    EXPECT_NEAR(seen.middle.y, 0.75, 0.01);
}

}  // namespace
}  // namespace petzval::integrator
