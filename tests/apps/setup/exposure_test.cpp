// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/exposure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/tiny_gltf.h"

namespace petzval::apps {
namespace {

std::vector<double> shares(std::initializer_list<std::pair<int, double>> parts) {
    std::vector<double> out;
    for (const auto& [count, value] : parts) out.insert(out.end(), size_t(count), value);
    return out;
}

TEST(ExposureFor, MakesTheLogAverageMidGrey) {
    EXPECT_EQ(exposure_for(shares({{100, 0.18}})).ev, 0.f);
    EXPECT_EQ(exposure_for(shares({{100, 0.18 / 8}})).ev, 3.f);
    EXPECT_EQ(exposure_for(shares({{100, 0.18e5}})).ev, -16.6f);
    const FoundExposure mixed = exposure_for(shares({{50, 0.09}, {50, 0.36}}));
    EXPECT_NEAR(mixed.log_average, 0.18, 1e-12);
    EXPECT_EQ(mixed.ev, 0.f);
}

TEST(ExposureFor, LetsNoMoreThanATenthBeWhite) {
    EXPECT_EQ(exposure_for(shares({{85, 0.01}, {15, 1.}})).ev, 0.f);
    EXPECT_GT(exposure_for(shares({{95, 0.01}, {5, 1.}})).ev, 3.5f);
}

TEST(ExposureFor, IsNotMovedByAFewOutliers) {
    const float ev = exposure_for(shares({{1000, 0.18}})).ev;
    EXPECT_NEAR(exposure_for(shares({{1000, 0.18}, {5, 1e9}})).ev, ev, 0.2f);
    EXPECT_NEAR(exposure_for(shares({{1000, 0.18}, {5, 1e-30}})).ev, ev, 0.2f);
}

TEST(ExposureFor, StaysWithinWhatCanBeTyped) {
    EXPECT_EQ(exposure_for({}).ev, 0.f);
    EXPECT_EQ(exposure_for({}).log_average, 0);
    EXPECT_EQ(exposure_for(shares({{9, 1e-300}})).ev, 100.f);
    EXPECT_EQ(exposure_for(shares({{9, 1e300}})).ev, -100.f);
    EXPECT_FALSE(std::signbit(exposure_for(shares({{9, 0.1801}})).ev));
}

TEST(BrightnessOf, TellsFilmsThatShowNothing) {
    const auto of = [](float value, float other, int others) {
        Film film({20, 20}, {0, 0, 20, 20}, {});
        for (int i = 0; i < 400; ++i) {
            FilmSample sample;
            sample.colour = Rgb(i < others ? other : value);
            sample.alpha = 1;
            film.add(i % 20, i / 20, 0, sample);
        }
        return film;
    };
    EXPECT_EQ(brightness_of(of(0.5f, 0, 0), 0), Brightness::Normal);
    EXPECT_EQ(brightness_of(of(0, 0, 0), 0), Brightness::Black);
    EXPECT_EQ(brightness_of(of(1e-4f, 0, 0), 0), Brightness::AlmostBlack);
    EXPECT_EQ(brightness_of(of(1e-4f, 100, 3), 0), Brightness::AlmostBlack);  // a lamp in view
    EXPECT_EQ(brightness_of(of(1e-4f, 1, 60), 0), Brightness::MostlyBlack);
    EXPECT_EQ(brightness_of(of(1e-4f, 1, 210), 0), Brightness::Normal);
    EXPECT_EQ(brightness_of(of(0, 1, 60), 0), Brightness::Normal);  // on black
    EXPECT_EQ(brightness_of(of(1e-4f, 0, 0), 8), Brightness::Normal);
    EXPECT_EQ(brightness_of(of(2, 0, 0), 0), Brightness::AlmostWhite);
    EXPECT_EQ(brightness_of(of(2, 0, 200), 0), Brightness::AlmostWhite);  // on black
    EXPECT_EQ(brightness_of(of(2, 0.5f, 60), 0), Brightness::Normal);
    EXPECT_EQ(brightness_of(of(2, 0, 0), -2), Brightness::Normal);
    EXPECT_EQ(brightness_of(of(1, 0, 0), 0), Brightness::Normal);  // white, as it was asked for
}

TEST(ExposureAdvice, LeavesWhatMayBeMeantToBeDark) {
    const auto says = [](Brightness brightness, float found_ev) {
        return exposure_advice(brightness, {found_ev, 0.18 * std::exp2(-double(found_ev))}, 0)
            .value_or("");
    };
    EXPECT_EQ(says(Brightness::Normal, 9), "");
    EXPECT_EQ(says(Brightness::AlmostBlack, 0.9f), "");
    EXPECT_EQ(says(Brightness::MostlyBlack, 2.9f), "");
    EXPECT_EQ(says(Brightness::MostlyBlack, -9), "");
    EXPECT_THAT(
        says(Brightness::MostlyBlack, 3),
        testing::StartsWith("the picture is mostly black: its log-average is 3.0 EV below"));
    EXPECT_THAT(says(Brightness::AlmostBlack, 2), testing::HasSubstr("almost black"));
    EXPECT_THAT(says(Brightness::AlmostWhite, -2), testing::HasSubstr("2.0 EV above mid-grey"));
}

class FindExposure : public testing::Test {
  protected:
    TempFolder folder_;

    FoundExposure find(const TinyGltf& file, const std::function<void(SceneRequest&)>& change = {},
                       const integrator::PathOptions& options = {}, uint32_t seed = 0,
                       int threads = 2) {
        integrator::TbbExecutor executor(threads);
        SceneRequest request;
        request.scene = file.save_glb(folder_.path / "scene.glb");
        request.size = {160, 90};
        request.camera.look_at = {V3f(0, 0, 3), V3f(0, 0, 0)};
        if (change) change(request);
        const RenderSetup setup = set_up_render(request, [](const std::string&) {});
        integrator::RenderJob job;
        job.seed = seed;
        return find_exposure(setup, job, options, executor);
    }
    /// A square of that half side about the origin that emits so many nits towards +z.
    static TinyGltf glow(float half_m, float nits) {
        TinyGltf file;
        const float r = half_m;
        nlohmann::json primitive = {
            {"material",
             file.add("materials",
                      {{"emissiveFactor", {1, 1, 1}},
                       {"extensions",
                        {{"KHR_materials_emissive_strength", {{"emissiveStrength", nits}}}}}})}};
        file.json["extensionsUsed"] = {"KHR_materials_emissive_strength"};
        primitive["attributes"]["POSITION"] =
            file.add_positions({-r, -r, 0, r, -r, 0, r, r, 0, -r, r, 0});
        primitive["indices"] = file.add_accessor<uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3});
        file.add_root({{"mesh", file.add_mesh(primitive)}});
        return file;
    }
};

TEST_F(FindExposure, MetersTheSceneAndNotWhatIsBehindIt) {
    const auto sky = [](float nits) {
        return [nits](SceneRequest& r) { r.background = Rgb(nits); };
    };
    // At 10 nits; the pixels of its rim show less.
    EXPECT_NEAR(find(glow(0.8f, 10), sky(0)).ev, -5.7f, 0.15f);
    EXPECT_NEAR(find(glow(0.8f, 10), sky(0.01f)).ev, -5.7f, 0.15f);
    integrator::PathOptions transparent;
    transparent.transparent = true;
    EXPECT_NEAR(find(glow(0.8f, 10), sky(0.01f), transparent).ev, -5.7f, 0.15f);
    // Hardly any pixel shows the scene: the background counts.
    EXPECT_NEAR(find(glow(0.003f, 10), sky(0.09f)).ev, 1.f, 0.11f);
}

TEST_F(FindExposure, FindsTinyLamps) {
    const auto black = [](SceneRequest& r) {
        r.background = Rgb(0.f);
        r.size = {640, 360};
    };
    // About 5 x 5 pixels, then 2 x 2.
    EXPECT_NEAR(find(glow(0.015f, 1000), black).ev, -12.4f, 2.f);
    EXPECT_LT(find(glow(0.006f, 1e6f), black).ev, -10);
    const FoundExposure none = find(glow(0.3f, 0), black);
    EXPECT_EQ(none.ev, 0.f);
    EXPECT_EQ(none.log_average, 0);
}

TEST_F(FindExposure, GoesThroughTheCameraThatIsAskedFor) {
    const float pinhole = find(glow(1, 100)).ev;
    const auto lens = [](const char* name, ExposureMode mode) {
        return [=](SceneRequest& r) {
            r.camera.lens = name;
            r.camera.fstop = 4;
            r.camera.exposure = mode;
            if (r.camera.lens == "thin") r.camera.natural_vignetting = false;
        };
    };
    for (const char* name : {"thin", "double-gauss-100mm-f2"}) {
        EXPECT_NEAR(find(glow(3, 100), lens(name, ExposureMode::Normalised)).ev, pinhole, 0.21f);
        // Of 100 nits, pi / (4 N^2) L t S / 78 is 0.06 at 1/100 s, ISO 100 and f/4.
        const float photographic = find(glow(3, 100), lens(name, ExposureMode::Photographic)).ev;
        EXPECT_NEAR(photographic, std::log2(0.18 / 0.0629), 0.31) << name;
    }
    const auto spectral = [](SceneRequest& r) { r.spectral.mode = SpectralMode::Wavelengths; };
    EXPECT_NEAR(find(glow(1, 100), spectral).ev, pinhole, 0.11f);
}

TEST_F(FindExposure, FollowsFromTheFrameAndTheSeedAlone) {
    const auto sky = [](SceneRequest& r) { r.background = Rgb(0.3f); };
    const FoundExposure two = find(glow(1, 0), sky);
    EXPECT_EQ(find(glow(1, 0), sky, {}, 0, 1).log_average, two.log_average);
    EXPECT_EQ(find(glow(1, 0), sky, {}, 0, 5).log_average, two.log_average);
    EXPECT_EQ(find(glow(1, 0), sky).log_average, two.log_average);
    EXPECT_NE(find(glow(1, 0), sky, {}, 1).log_average, two.log_average);
}

}  // namespace
}  // namespace petzval::apps
