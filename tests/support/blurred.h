// SPDX-License-Identifier: Apache-2.0
// A picture with motion blur, and the mean of stills at stratified times: two ways to one picture.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <vector>

#include "camera/models/moving_camera.h"
#include "core/scene/motion.h"
#include "integrator/render/executor.h"
#include "integrator/render/render.h"
#include "tests/support/moving.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace petzval::test {

/// What is rendered: a scene that is not finished yet, and a camera for each time.
struct Motion {
    Scene scene;
    std::function<std::unique_ptr<camera::Camera>(const M44f& to_world)> camera;
    /// Places of the camera at steps; one: it stands still.
    std::vector<M44f> camera_steps;
    integrator::PathOptions options{};
    camera::ShutterCurve curve = camera::ShutterCurve::box();
    V2i size{8, 6};
};

inline Light between(const Light& a, const Light& b, double share) {
    return std::visit(
        [&](auto one) -> Light {
            const auto& other = std::get<decltype(one)>(b);
            const auto mix = [&](const V3f& x, const V3f& y) {
                return V3f(V3d(x) * (1 - share) + V3d(y) * share);
            };
            if constexpr (requires { one.position; })
                one.position = mix(one.position, other.position);
            if constexpr (requires { one.direction; })
                one.direction = mix(one.direction, other.direction).normalized();
            return one;
        },
        a);
}

/// The scene as it stands at a time, by the tests' own ways; nothing in it moves.
[[nodiscard]] inline Scene frozen(const Scene& scene, double time) {
    Scene out = scene;
    out.motions.clear();
    out.motion_of.clear();
    out.light_motions.clear();
    out.light_motion_of.clear();
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        Instance& instance = out.instances[i];
        if (!instance.moves) continue;
        const M44d m = matrix_at(scene, i, time);
        instance.moves = false;
        instance.to_world = M44f(m);
        instance.to_local = M33f(linear_part(m.inverse()));
        instance.flips = m.determinant() < 0;
    }
    for (Mesh& mesh : out.meshes) {
        if (mesh.steps.empty()) continue;
        const auto [before, share] = place_of_time(time, mesh.steps.size());
        const MeshStep &a = mesh.steps[before], &b = mesh.steps[before + 1];
        for (size_t v = 0; v < mesh.positions.size(); ++v)
            mesh.positions[v] = a.positions[v] * float(1 - share) + b.positions[v] * float(share);
        for (size_t v = 0; v < mesh.normals.size(); ++v)
            mesh.normals[v] = a.normals[v] * float(1 - share) + b.normals[v] * float(share);
        for (size_t v = 0; v < mesh.tangents.size(); ++v)
            mesh.tangents[v] = a.tangents[v] * float(1 - share) + b.tangents[v] * float(share);
        mesh.steps.clear();
    }
    for (size_t i = 0; i < scene.light_motion_of.size(); ++i) {
        if (scene.light_motion_of[i] < 0) continue;
        const auto& steps = scene.light_motions[size_t(scene.light_motion_of[i])];
        const auto [before, share] = place_of_time(time, steps.size());
        out.lights[i] = between(steps[before], steps[before + 1], share);
    }
    return out;
}

/// Renders a scene that is not finished; returns the green of all pixels.
class Renderer {
  public:
    Renderer(Scene scene, const integrator::PathOptions& options) : scene_(std::move(scene)) {
        finish_scene(scene_);
        bvh_ = std::make_unique<Bvh>(scene_, Traversal::Robust);
        lights_ = std::make_unique<LightChoice>(scene_, LightChoiceKind::Tree);
        tracer_ = std::make_unique<integrator::PathTracer<>>(scene_, *bvh_, *lights_, options);
    }

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] std::vector<float> operator()(const camera::Camera& camera, V2i size,
                                                uint32_t spp, uint32_t seed, int threads = 1,
                                                int tile_size_px = 16) const {
        integrator::RenderJob job;
        job.end_sample = spp;
        job.seed = seed;
        job.tile_size_px = tile_size_px;
        job.filter = Filter(FilterKind::Box, 0.5f);
        Film film(size, {0, 0, size.x, size.y}, {});
        integrator::ThreadExecutor executor(threads);
        integrator::RenderMonitor monitor;
        (void)integrator::render(*tracer_, camera, job, film, executor, monitor);
        EXPECT_EQ(film.left_out().count(), 0u);
        std::vector<float> out;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) out.push_back(film.colour(x, y)[1]);
        return out;
    }

  private:
    Scene scene_;
    std::unique_ptr<Bvh> bvh_;
    std::unique_ptr<LightChoice> lights_;
    std::unique_ptr<integrator::PathTracer<>> tracer_;
};

/// Pose of the camera of a motion in the middle of the exposure.
[[nodiscard]] inline M44f middle_pose(const Motion& motion) {
    const auto& steps = motion.camera_steps;
    return (steps[(steps.size() - 1) / 2] + steps[steps.size() / 2]) * 0.5f;
}

/// The camera of a motion, where it stands in the middle of the exposure.
[[nodiscard]] inline std::shared_ptr<const camera::Camera> middle_camera(const Motion& motion) {
    return motion.camera(middle_pose(motion));
}

/// A camera of a motion with its shutter.
[[nodiscard]] inline std::unique_ptr<camera::Camera> shuttered(
    const Motion& motion, std::shared_ptr<const camera::Camera> still) {
    const auto& steps = motion.camera_steps;
    const std::span<const M44f> moves(steps.data(), steps.size() > 1 ? steps.size() : 0);
    return std::make_unique<camera::MovingCamera>(
        std::move(still),
        std::make_shared<const camera::Shutter>(motion.curve, moves, middle_pose(motion)));
}
[[nodiscard]] inline std::unique_ptr<camera::Camera> shuttered(const Motion& motion) {
    return shuttered(motion, middle_camera(motion));
}

using Pixels = std::vector<Moments>;

inline void add(Pixels& to, const std::vector<float>& picture) {
    to.resize(picture.size());
    for (size_t i = 0; i < picture.size(); ++i) to[i].add(double(picture[i]));
}

inline constexpr uint32_t kBlurredSeeds = 20, kStills = 12;

/// Means of pixels over seeds, with the shutter.
[[nodiscard]] inline Pixels blurred(const Motion& motion, const camera::Camera& camera,
                                    uint32_t spp) {
    const Renderer renderer(motion.scene, motion.options);
    Pixels out;
    for (uint32_t seed = 0; seed < kBlurredSeeds; ++seed)
        add(out, renderer(camera, motion.size, spp, seed));
    return out;
}

/// The same of averages of stills, each at a random time of its part of the exposure.
[[nodiscard]] inline Pixels of_stills(const Motion& motion, uint32_t spp) {
    const camera::Shutter shutter(motion.curve, {}, M44f());
    Pixels out;
    Random random(77);
    for (uint32_t seed = 0; seed < kBlurredSeeds; ++seed) {
        std::vector<float> mean;
        for (uint32_t i = 0; i < kStills; ++i) {
            const float time = shutter.time((float(i) + random.next()) / float(kStills));
            const auto& steps = motion.camera_steps;
            M44f stands = steps[0];
            if (steps.size() > 1) {
                const auto [before, share] = place_of_time(double(time), steps.size());
                stands = steps[before] * float(1 - share) + steps[before + 1] * float(share);
            }
            const Renderer still(frozen(motion.scene, double(time)), motion.options);
            const auto picture =
                still(*motion.camera(stands), motion.size, spp, 1000 + seed * kStills + i);
            mean.resize(picture.size());
            for (size_t k = 0; k < mean.size(); ++k) mean[k] += picture[k] / float(kStills);
        }
        add(out, mean);
    }
    return out;
}

/// Whether two pictures are the same in every pixel but for chance, and not all one grey.
[[nodiscard]] inline ::testing::AssertionResult same_picture(const Pixels& a, const Pixels& b) {
    const double bound = sidak(kStatisticalTests * static_cast<int>(a.size()));
    double least = 1, darkest = HUGE_VAL, brightest = 0;
    size_t worst = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double p = p_of(Mean(a[i]) - Mean(b[i]), 0, 1e-4 * std::fabs(b[i].mean()));
        darkest = std::min(darkest, b[i].mean());
        brightest = std::max(brightest, b[i].mean());
        if (p < least) worst = i;
        least = std::min(least, p);
    }
    if (!(brightest > 1.2 * darkest)) return ::testing::AssertionFailure() << "nothing to compare";
    if (least >= bound) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "pixel " << worst << " is " << Mean(a[worst])
                                         << ", not " << Mean(b[worst]) << ": p = " << least;
}

}  // namespace petzval::test
