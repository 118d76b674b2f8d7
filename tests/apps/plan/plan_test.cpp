// SPDX-License-Identifier: Apache-2.0
// What a pilot finds, what a plan makes of it, and what petzval plan says.
#include "apps/plan/plan.h"

#include <gmock/gmock.h>

#include <cmath>

#include "apps/plan/plan_wording.h"
#include "camera/setup/lateral_dispersion.h"
#include "core/film/spectral_film.h"
#include "io/image/difference.h"
#include "io/image/picture_files.h"
#include "tests/apps/plan/plans.h"
#include "tests/support/statistics.h"

namespace petzval::apps {
namespace {

using test::Mean;

// Nothing but a sky: a picture without noise, whose error is known to the last digit.
TEST_F(Plans, APilotFindsADifferenceThatIsKnown) {
    TinyGltf nothing;
    add_perspective(nothing, "wide", 1.f);
    use(nothing);
    SceneRequest one = request(scene_, {64, 36}), more = one;
    one.background = Rgb(1, 1, 1);
    more.background = Rgb(1.02f, 1, 1);
    const Pilot pilot({64, 36}, 100, executor_);
    EXPECT_NEAR(double(pilot.pixels()), 100, 10);
    const auto a = model(pilot, more), b = model(pilot, one);
    pilot.sample(*a, 4);
    pilot.sample(*b, 4);
    const Estimate found = bias(pilot, *a, *b);
    const double floor = io::kSymmetricFloorShare * 1, middle = (1.02 * 1.02 + 1) / 2;
    EXPECT_NEAR(found.mean, 0.02 * 0.02 / (middle + floor * floor) / 3, 1e-9);
    EXPECT_NEAR(found.error, 0, 1e-9);
    EXPECT_NEAR(noise(pilot, *a, *b).mean, 0, 1e-12);
}

// A white lamp is white in RGB and in wavelengths, which are noisy: the square of the difference is
// 0 but for the estimate's own error. The mean of squares is not.
TEST_F(Plans, NoiseIsNoBias) {
    use(lamp());
    SceneRequest rgb = request(scene_, {64, 36}), hero = rgb;
    hero.spectral.mode = SpectralMode::Wavelengths;
    const Pilot pilot({64, 36}, 600, executor_);
    const auto a = model(pilot, hero), b = model(pilot, rgb);
    pilot.sample(*a, 4);
    pilot.sample(*b, 4);
    const Estimate found = bias(pilot, *a, *b);
    EXPECT_TRUE(test::agrees({found.mean, found.error}, 0)) << found.mean << ' ' << found.error;
    EXPECT_GT(noise(pilot, *a, *b).mean, 10 * found.error);
    EXPECT_NEAR(noise(pilot, *b, *b).mean, 0, 1e-12);
}

// Pixels that differ by chance only: a pilot's variance is that of the same number of samples
// anywhere, and falls in proportion where points are independent.
TEST_F(Plans, VarianceIsThatOfALook) {
    const Pilot pilot({64, 36}, 600, executor_);
    integrator::RenderJob job;
    job.sampler = SamplerKind::Independent;
    const auto a = pilot.model(set_up_render(request(scene_, {64, 36}), kSilent), job,
                               integrator::PathOptions());
    pilot.sample(*a, 8);
    const Estimate eight = noise(pilot, *a, *a);
    pilot.sample(*a, 32);
    const Estimate all = noise(pilot, *a, *a);
    EXPECT_TRUE(test::agrees(Mean(eight.mean, eight.error) - Mean(4 * all.mean, 4 * all.error), 0))
        << eight.mean << ' ' << all.mean;
    EXPECT_FALSE(test::agrees({eight.mean, eight.error}, 0)) << "there is some";
}

TEST_F(Plans, LateralDispersionIsInPixels) {
    const SceneRequest narrow = tabletop({100, 60});
    const RenderSetup split = set_up_render(with(narrow, camera::DispersionMode::Split), kSilent);
    const auto view = [&](camera::DispersionMode mode) {
        return set_up_view(split, with(narrow, mode), kSilent).view.still;
    };
    const auto shared = view(camera::DispersionMode::Shared);
    const auto dispersion_px = [&](const camera::Camera& camera, V2i size) {
        return camera::lateral_dispersion_px(camera, *shared, split.view.observer,
                                             split.from.camera.focus_plane(), size);
    };
    const double once = dispersion_px(*split.view.still, {100, 60});
    EXPECT_NEAR(dispersion_px(*split.view.still, {400, 240}), 4 * once, 0.02 * once);
    EXPECT_NEAR(dispersion_px(*shared, {100, 60}), 0, 1e-4 * once);
}

// The fixed sample of tests/measure/plan_check: predictions hold on other pixels and seeds.
TEST_F(Plans, PredictionsHoldAndAreNotThreeTimesTooCareful) {
    constexpr double kTolerance = 0.1;
    SceneRequest scene = tabletop({160, 90}, "cooke-triplet-50mm-f5");
    scene.scene = kOrnaments;
    const Plan plan = make_plan({scene, {}, {}, kTolerance}, executor_, kSilent, 1e6);
    const RenderSetup first = set_up_render(scene, kSilent);
    const Pilot pilot(scene.size, 512, executor_, 1);
    const auto full = model(pilot, plan.candidates.back().scene);
    const auto samples = static_cast<uint32_t>(plan.samples);
    ASSERT_LT(samples, 400u);
    pilot.sample(*full, samples);
    // Is the mean between a ninth of the prediction's square and all of it, but for chance? Small
    // predictions may be as careful as they like.
    const auto holds = [&](double predicted, const Mean& mean) {
        const double most = predicted * predicted;
        const double least = predicted <= kTolerance / 4 ? -HUGE_VAL : most / 9;
        return mean.value > most ? test::agrees(mean, most)
                                 : mean.value >= least || test::agrees(mean, least);
    };
    for (const PlanCandidate& c : plan.candidates) {
        if (c.model == PlanModel::Split) continue;
        const auto simpler = model(pilot, c.scene);
        pilot.sample(*simpler, samples);
        const Estimate off = bias(pilot, *simpler, *full);
        EXPECT_TRUE(holds(c.predicted(), {off.mean, off.error}))
            << name_of(c.model) << ' ' << c.predicted() << ' ' << off.mean << ' ' << off.error;
        if (c.model != plan.chosen) continue;
        const Estimate noisy = noise(pilot, *simpler, *full);
        EXPECT_TRUE(
            holds(plan.error(), {off.mean + noisy.mean, std::hypot(off.error, noisy.error)}))
            << plan.error() << ' ' << off.mean << ' ' << noisy.mean;
    }
    EXPECT_LE(plan.error(), kTolerance * (1 + 1e-9));
    EXPECT_GT(plan.error(), 0.7 * kTolerance) << "samples are whole";
}

// Clusters of lamps that span the frame are dark in most of their pixels. 3000 pixels with 4 x 256
// samples say that a pinhole is off by 48 % here, and a thin lens by 40 %.
TEST_F(Plans, ClustersOfLampsDoNotMakeTheirWholeAreaLookBright) {
    SceneRequest scene = tabletop({160, 90});
    scene.camera.focus = FocusDistance{1};
    const Plan plan = make_plan({scene, {}, {}, 0.05}, executor_, kSilent, 1e6);
    EXPECT_GT(plan.find(PlanModel::Pinhole)->predicted(), 0.45);
    EXPECT_GT(plan.find(PlanModel::Thin)->predicted(), 0.38);
}

// Far away nothing is sharper or blurrier than a pinhole shows it; near, everything is.
TEST_F(Plans, APinholeDoesWhereTheBlurIsSmall) {
    EXPECT_EQ(planned({"--fstop", "20000", "--focus", "2"})["camera"]["chosen"], "pinhole");
    const json near = planned({"--fstop", "0.5", "--focus", "0.1", "--focal-length", "50"});
    EXPECT_EQ(near["camera"]["chosen"], "thin");
    EXPECT_NE(near["camera"]["reason"].get<std::string>().find("pinhole would be off by"),
              std::string::npos);
}

TEST_F(Plans, ReasonsAreGivenInALineEach) {
    json plan = planned({});
    EXPECT_EQ(plan["camera"]["reason"], "nothing has an iris");
    EXPECT_EQ(plan["spectral"]["chosen"], "rgb");
    EXPECT_EQ(plan["spectral"]["reason"], "nothing depends on wavelength");
    EXPECT_EQ(plan["dispersion"]["reason"], "no lens sends wavelengths apart");
    EXPECT_TRUE(plan["dispersion"]["predicted_error"].is_null());
    plan = planned({"--spectral", "wavelengths"});
    EXPECT_EQ(plan["spectral"]["chosen"], "wavelengths");
    EXPECT_EQ(plan["spectral"]["reason"], "it was asked for");
    plan = planned({"--lens", "double-gauss-100mm-f2", "--focus", "2", "--tolerance", "8%"});
    EXPECT_EQ(plan["camera"]["chosen"], "double-gauss-100mm-f2");
    const auto dispersion = plan["dispersion"]["reason"].get<std::string>();
    EXPECT_TRUE(dispersion.starts_with("dispersion of double-gauss-100mm-f2 spreads 0.0"))
        << dispersion;
    EXPECT_NE(dispersion.find(" px: one ray for all wavelengths, off by "), std::string::npos);
    EXPECT_EQ(plan["dispersion"]["chosen"], "shared");
    plan = planned(
        {"--lens", "double-gauss-100mm-f2", "--focus", "2", "--method", "dispersion=split"});
    EXPECT_EQ(plan["dispersion"]["chosen"], "split");
    EXPECT_EQ(plan["dispersion"]["reason"], "it was asked for");
}

TEST_F(Plans, AGemThatDispersesNeedsWavelengths) {
    scene_ = PETZVAL_ASSETS "/scenes/gem.glb";
    const json plan = planned({"--tolerance", "20%"});
    EXPECT_EQ(plan["spectral"]["chosen"], "wavelengths");
    EXPECT_NE(plan["spectral"]["reason"].get<std::string>().find("rgb would be off by"),
              std::string::npos)
        << plan;
}

// A picture without noise is known, however few paths it took; a frame of one pixel is planned.
TEST_F(Plans, NothingIsAtLeastWhereThereIsNoNoise) {
    for (const char* background : {"0,0,0", "1,1,1"})
        for (const char* size : {"1x1", "32x18"}) {
            const json plan =
                planned({"--look-at", "0,0,0,0,9,0.1", "--background", background, "--size", size});
            EXPECT_EQ(plan["noise_at_least"], false) << background << plan;
            EXPECT_EQ(plan["samples"], 1) << plan;
            EXPECT_EQ(plan["predicted_noise"], 0.) << plan;
        }
}

TEST_F(Plans, SpectraTakeAsManySamplesInEachReplicate) {
    EXPECT_EQ(planned({"--tolerance", "100%"})["samples"], 1);
    EXPECT_EQ(planned({"--tolerance", "100%", "--bins", "400:700:100"})["samples"], kReplicates);
}

// The first samples of a pilot met no light, those that followed did: one sample is not enough.
TEST_F(Plans, NoiseThatTheFirstSamplesMissedCounts) {
    PlanCandidate c{PlanModel::Full, {}};
    c.noise.variances = {{0, 0}, {0, 0}, {0.25, 0.01}};
    c.noise.parts = 100;
    EXPECT_NEAR(c.variance_with(1), 1, 1e-12);
    EXPECT_NEAR(c.variance_with(2), 0.5, 1e-12);
    EXPECT_GT(c.samples_for(0.1), 100);
    EXPECT_FALSE(c.noise_at_least());
    c.noise.parts = 10;
    EXPECT_TRUE(c.noise_at_least());
}

// Lamps of a millimetre far out of focus: paths hardly find them, and the plan says so.
TEST_F(Plans, NoiseOfLampsThatFewPathsFindIsAtLeast) {
    json strong;
    strong["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 1e9;
    TinyGltf tiny = lamp(strong);
    for (auto& node : tiny.json["nodes"])
        if (node.contains("mesh")) node["scale"] = {1e-6, 1e-6, 1e-6};
    use(tiny);
    const json plan = planned({"--fstop", "1.4", "--focus", "0.3", "--tolerance", "100%",
                               "--background", "0.01,0.01,0.01", "--method", "targets=off"});
    EXPECT_EQ(plan["noise_at_least"], true) << plan;
    EXPECT_NE(plan["noise_at_least_because"].get<std::string>().find("few paths find"),
              std::string::npos)
        << plan;
}

// A render says so too, but not where rays are sent to them, nor of lamps that nobody would see.
TEST_F(Plans, ARenderWarnsOfLampsThatFewPathsMeet) {
    const auto said = [&](double strength, const char* targets) {
        json emissive;
        emissive["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
        TinyGltf tiny = lamp(emissive);
        for (auto& node : tiny.json["nodes"])
            if (node.contains("mesh"))
                node.update({{"scale", {1e-4, 1e-4, 1e-4}}, {"translation", {0.05, 0.03, -1}}});
        use(tiny);
        const Finished run = run_petzval({"render",       scene_,
                                          "--threads",    "2",
                                          "--fov",        "10",
                                          "--fstop",      "4",
                                          "--focus",      "0.5",
                                          "--background", "0.5,0.5,0.5",
                                          "--size",       "64x36",
                                          "--spp",        "8",
                                          "--method",     "targets=" + std::string(targets),
                                          "-o",           path("lamp.exr")});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return run.err;
    };
    const auto warning = testing::HasSubstr("fewer than 16 paths meet a lamp of ");
    EXPECT_THAT(said(1e5, "off"), warning);
    EXPECT_THAT(said(1e5, "auto"), testing::Not(warning));
    EXPECT_THAT(said(1e-3, "off"), testing::Not(warning));
}

// A plan sees lamps by the rays that are sent to them, and says what they spare.
TEST_F(Plans, RaysToTargetsMakeLampsKnown) {
    json strong;
    strong["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 1e5;
    TinyGltf tiny = lamp(strong);
    for (auto& node : tiny.json["nodes"])
        if (node.contains("mesh"))
            node.update({{"scale", {1e-4, 1e-4, 1e-4}}, {"translation", {0.05, 0.03, -1}}});
    use(tiny);
    const auto options = [](const char* use) {
        return Words{"--fov",       "10",   "--fstop",      "4",
                     "--focus",     "0.5",  "--background", "0.5,0.5,0.5",
                     "--tolerance", "20%",  "--method",     "targets=" + std::string(use),
                     "--size",      "64x36"};
    };
    const auto with = [&](const char* use) { return planned(options(use)); };
    const json automatic = with("auto"), off = with("off");
    ASSERT_TRUE(automatic.contains("targets")) << automatic << off;
    EXPECT_EQ(automatic["targets"]["lamps"], 1) << automatic;
    EXPECT_GT(automatic["targets"]["times_samples_without"].get<double>(), 4) << automatic;
    EXPECT_FALSE(off.contains("targets")) << off;
    EXPECT_GT(off["samples"].get<double>(), 4 * automatic["samples"].get<double>())
        << automatic << off;
    Words words = options("auto");
    words.insert(words.begin(), {"plan", scene_});
    const Finished text = run_petzval(words);
    const size_t samples = text.out.find("\nsamples "), targets = text.out.find("\ntargets ");
    ASSERT_NE(targets, std::string::npos) << text.out << text.err;
    EXPECT_EQ(text.out.find('\n', samples + 1), targets) << text.out;
}

TEST(PlanWords, LampsAreInMillimetresAndSpotsOfTheSkyInDegrees) {
    Plan plan;
    plan.rare = {.seldom = {.lamps = 30, .spots = 1}, .noise = 1};
    SmallLamps& seldom = plan.rare.seldom;
    seldom.largest_lamp_m = 2e-3;
    seldom.largest_spot_rad = double(kPi) / 360;
    EXPECT_EQ(rare_text(plan), "") << "the noise is known";
    plan.noise_at_least = true;
    EXPECT_EQ(
        rare_text(plan),
        "30 lamps of 2 mm at most and a spot of the sky of 0.5° at most: few paths find them");
    seldom.lamps = 0;
    EXPECT_EQ(rare_text(plan), "a spot of the sky of 0.5° at most: few paths find it");
    seldom.samples = 640;
    EXPECT_EQ(warning_of(seldom),
              "warning: fewer than 16 paths meet a spot of the sky of 0.5° at most: its light is "
              "missing, or in single bright pixels; ⟨spp⟩ 640 would do");
    EXPECT_EQ(warning_of({}), std::nullopt);
}

// Without the layers that a picture to a noise has.
io::Picture colours_of(io::Picture picture) {
    const size_t channels = picture.channels.size();
    std::vector<float> colours;
    for (size_t i = 0; i < picture.pixels.size(); ++i)
        if (i % channels < 4) colours.push_back(picture.pixels[i]);
    picture.pixels = std::move(colours);
    picture.channels.resize(4);
    return picture;
}

// The last lines are commands; what they write is about the tolerance off a long render.
TEST_F(Plans, TheCommandRenders) {
    const Words options = {"--fstop", "2", "--focus", "1.5", "--size", "48x27"};
    scene_ = kOrnaments;
    Words words = {"plan", scene_, "--tolerance", "8%"};
    words.insert(words.end(), options.begin(), options.end());
    const Finished run = run_petzval(words);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    std::istringstream lines(run.out);
    std::vector<std::string> all;
    for (std::string line; std::getline(lines, line);) all.push_back(line);
    const Words starts{"camera ",         "spectral ", "dispersion ",    "precision ", "ghosts ",
                       "diffraction ",    "lights ",   "samples ",       "error ",     "time ",
                       "petzval render ", "or ",       "petzval render "};
    ASSERT_EQ(all.size(), starts.size()) << run.out;
    for (size_t i = 0; i < all.size(); ++i) EXPECT_TRUE(all[i].starts_with(starts[i])) << all[i];
    Words long_render = options;
    long_render.insert(long_render.end(), {"--spp", "4096"});
    const io::Picture reference = render(long_render, "reference.exr");
    for (const size_t line : {starts.size() - 3, starts.size() - 1}) {
        std::istringstream command(all[line]);
        Words parts;
        for (std::string word; command >> word;) parts.push_back(word);
        ASSERT_EQ(parts[0], "petzval");
        ASSERT_EQ(parts.back(), "out.exr");
        parts.erase(parts.begin());
        parts.back() = path("out.exr");
        parts.emplace_back("--quiet");
        const Finished rendered = run_petzval(parts);
        EXPECT_THAT(rendered.exit_code, testing::AnyOf(0, 5)) << rendered.err;
        const double mse = *io::compare(colours_of(io::read_picture(path("out.exr"))), reference)
                                .front()
                                .symmetric_mse;
        EXPECT_LT(std::sqrt(mse), 1.25 * 0.08) << "one picture, and what is predicted is the mean";
        EXPECT_GT(std::sqrt(mse), 0.08 / 4) << "a part of the picture may need more than others";
    }
}

TEST(PlanWords, GhostsAreALineWithAReason) {
    const auto line = [](camera::Coating coating, GhostUse use,
                         const std::optional<GhostsFound>& found) {
        Plan plan;
        plan.requested.asked.camera.coating = coating;
        plan.requested.asked.camera.ghosts = use;
        plan.ghosts = found;
        for (const PlanLine& one : lines_of(plan))
            if (one.choice == "ghosts") return one.chosen + ": " + one.reason;
        return std::string();
    };
    using enum GhostUse;
    EXPECT_EQ(line(camera::Coating::MgF2, Auto, {}), "off: no lens is traced");
    EXPECT_EQ(line(camera::Coating::MgF2, Off, GhostsFound{false, 3, {}}), "off: it was asked for");
    EXPECT_EQ(line(camera::Coating::Ideal, Auto, GhostsFound{false, 0, {}}),
              "off: no surface reflects, and no lamp shines into the lens");
    EXPECT_EQ(line(camera::Coating::Ideal, Auto, GhostsFound{false, 3, {}}),
              "off: no surface reflects; 3 lamps shine into the lens: ⟨coating⟩=year shows ghosts");
    EXPECT_EQ(line(camera::Coating::Year, Only, GhostsFound{true, 1, 1.}),
              "only: surfaces reflect, with coating year; a lamp shines into the lens");
    EXPECT_EQ(line(camera::Coating::MgF2, Auto, GhostsFound{true, 0, 0.012}),
              "auto: surfaces reflect, with coating mgf2, about 1.2 % of the picture's light");
}

TEST_F(Plans, TheShareOfGhostsIsThatOfARender) {
    scene_ = PETZVAL_ASSETS "/scenes/low_sun.glb";
    SceneRequest asked = request(scene_, {32, 18});
    asked.camera.lens = "double-gauss-100mm-f2";
    asked.camera.focus = FocusDistance{9};
    asked.camera.coating = camera::Coating::Uncoated;
    const Plan plan = make_plan({asked, {}, {}, 0.1}, executor_, kSilent, 1e5);
    ASSERT_TRUE(plan.ghosts && plan.ghosts->share);
    EXPECT_TRUE(plan.ghosts->shown);
    EXPECT_EQ(plan.ghosts->lamps, 1u);
    const io::Picture long_render =
        render({"--lens", "double-gauss-100mm-f2", "--focus", "9", "--method", "coating=uncoated",
                "--aov", "ghosts", "--size", "32x18", "--spp", "512"});
    double ghosts = 0, all = 0;
    for (int y = 0; y < 18; ++y)
        for (int x = 0; x < 32; ++x) {
            ghosts += double(value_at(long_render, x, y, "ghosts.G"));
            all += double(value_at(long_render, x, y, "G"));
        }
    EXPECT_NEAR(*plan.ghosts->share, ghosts / all, 0.25 * ghosts / all);
}

TEST_F(Plans, NeedlessOptionsAreLeftOutOfTheCommandAndOddWordsQuoted) {
    scene_ = studio().save_glb(folder_.path / "it's a studio.glb").string();
    const json plan = planned({"--lens", "double-gauss-100mm-f2", "--fstop", "22", "--focus", "2",
                               "--tolerance", "100%", "--method", "coating=mgf2", "--transparent"});
    ASSERT_EQ(plan["camera"]["chosen"], "pinhole") << plan;
    const auto command = plan["command"].get<std::string>();
    EXPECT_NE(command.find("it'\\''s a studio.glb'"), std::string::npos) << command;
    for (const char* kept : {" --lens pinhole", " --fov ", " --transparent", " --spp "})
        EXPECT_NE(command.find(kept), std::string::npos) << kept << " in " << command;
    for (const char* gone :
         {"--fstop", "--focus", "coating", "--tolerance", "--json", "dispersion"})
        EXPECT_EQ(command.find(gone), std::string::npos) << gone << " in " << command;
}

TEST_F(Plans, ArgumentsThatAreWrongEndWithTwo) {
    const std::pair<Words, const char*> cases[] = {
        {{"plan"}, "SCENE is required"},
        {{"plan", scene_, "--tolerance", "0"}, "--tolerance: \"0\" is not a share"},
        {{"plan", scene_, "--tolerance", "101%"}, "is not a share such as 1% or 0.01"},
        {{"plan", scene_, "--tolerance", "%"}, "is not a share"},
        {{"plan", scene_, "--lens", "no-such-lens"}, "no-such-lens"},
        {{"plan", scene_, "--method", "dispersion=some"}, "none of auto, shared, hero, split"},
        {{"plan", kOrnaments, "--tolerance", "1e-7%", "--size", "8x8"},
         "--tolerance: would take more than 1.1e+09 samples of each pixel; give a larger one"},
        {{"plan", scene_, "--spp", "4"}, "--spp"}};
    for (const auto& [words, part] : cases) {
        const std::string line = error_of(words, 2);
        EXPECT_NE(line.find(part), std::string::npos) << line;
    }
    EXPECT_NE(error_of({"plan", path("none.glb")}, 1).find("none.glb"), std::string::npos);
}

}  // namespace
}  // namespace petzval::apps
