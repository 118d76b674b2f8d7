// SPDX-License-Identifier: Apache-2.0
// The record of a sample ends with what a render of the same sample gives its film, to the bit.
#include <gtest/gtest.h>

#include <functional>

#include "apps/render/render_session.h"
#include "apps/request/fields.h"

namespace petzval::apps {
namespace {

const io::Notice kUnheard = [](const std::string&) {};

/// A scene with fields of `petzval render`.
struct Case {
    const char* scene;
    std::vector<FieldTexts> fields;
    V2i size{24, 16};
    bool has_targets = false;  ///< lamps out of focus, or smaller than a pixel
};

/// Light that the events of a sample add up to, as the way to the film adds it.
V3f sum_of(const integrator::SampleRecord& sample) {
    f4 light{}, along{};
    size_t path = 0;
    const auto end_path = [&] {
        if (path == 0) return;
        const camera::CameraPath& ray = sample.rays[path - 1];
        light += ray.weight * ray.mis_weight * along;
        along = f4{};
    };
    for (const integrator::PathEvent& event : sample.events) {
        if (event.step == integrator::PathStep::Begins) end_path(), ++path;
        if (event.step == integrator::PathStep::Shines ||
            event.step == integrator::PathStep::Scatters || event.step == integrator::PathStep::Sky)
            along += event.lanes;
    }
    end_path();
    EXPECT_EQ(path, sample.rays.size());
    const Rgb sum = to_rgb(light, sample.bands);
    return {sum[0], sum[1], sum[2]};
}

class TraceSample : public ::testing::TestWithParam<Case> {};

TEST_P(TraceSample, GivesWhatTheFilmGets) {
    RenderRequest request = order_of(GetParam().fields).render;
    request.scene.scene = std::filesystem::path(PETZVAL_ASSETS) / "scenes" / GetParam().scene;
    const V2i size = request.scene.size = GetParam().size;
    constexpr uint32_t index = 5;
    request.samples.range = SampleRange{index, index + 1};
    if (request.scene.spectral.bins) request.samples.range = SampleRange{0, kReplicates};
    RenderSession session(1);
    session.prepare(request, kUnheard);
    integrator::RenderMonitor monitor;
    ASSERT_FALSE(session.render(monitor).stopped);
    const Film& film = session.film();
    int bright = 0, targets = 0;
    const int step = size.y / 14;
    for (int y = 0; y < size.y; y += step)
        for (int x = 0; x < size.x; x += step) {
            V4f all(0.f);
            const SampleRange range = *request.samples.range;
            for (uint32_t i = range.first; i < range.end; ++i) {
                const integrator::SampleRecord of = session.trace_sample({x, y, i});
                all += of.film;
                targets += static_cast<int>(
                    std::ranges::count_if(of.rays, &camera::CameraPath::to_target));
                const V3f sum =
                    request.samples.clamp_nits ? V3f(of.film.x, of.film.y, of.film.z) : sum_of(of);
                ASSERT_EQ(V3f(of.film.x, of.film.y, of.film.z), sum) << x << ',' << y;
            }
            const V4f mean = film.colour(x, y);
            bright += mean.x > 0;
            const float n = static_cast<float>(range.count());
            ASSERT_TRUE(all.equalWithRelError(mean * n, n > 1 ? 1e-5f : 0)) << x << ',' << y;
        }
    EXPECT_GT(bright, 20);
    EXPECT_EQ(targets > 0, GetParam().has_targets);
}

INSTANTIATE_TEST_SUITE_P(
    Of, TraceSample,
    ::testing::Values(
        Case{"first_light.glb", {{"seed", {"3"}}}},
        Case{"first_light.glb", {{"transparent", {"on"}}, {"clamp", {"0.5"}}, {"fstop", {"2"}}}},
        Case{
            "ornaments.glb", {{"lens", {"takumar-50mm-f1.2"}}, {"focus", {"0.4"}}}, {64, 42}, true},
        Case{"gem.glb", {{"spectral", {"wavelengths"}}}},
        Case{"gem.glb", {{"bins", {"400:700:100"}}}},
        Case{"wheels.glb", {{"at", {"0.1s"}}, {"shutter", {"180deg"}}}},
        Case{"glass.glb", {{"max-depth", {"3"}}, {"sampler", {"independent"}}}}));

}  // namespace
}  // namespace petzval::apps
