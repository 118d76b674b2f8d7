// SPDX-License-Identifier: Apache-2.0
// What petzval render chooses by itself, and what it says of that.
#include "io/image/picture_files.h"
#include "tests/apps/plan/plans.h"

namespace petzval::apps {
namespace {

/// Renders that choose for themselves, of a frame that is large enough for a pilot.
class AutoRender : public Plans {
  protected:
    AutoRender() { use(lamp()); }
    [[nodiscard]] static Words lens(Words more = {}) {
        Words words = {
            "--lens", "cooke-triplet-50mm-f5", "--focus", "2", "--size", "560x360", "--spp", "1"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
};

TEST_F(AutoRender, TakesRgbWhereTheLensDoesNotShow) {
    const std::string text = said(lens({"--tolerance", "5%"}), "auto.exr");
    EXPECT_NE(text.find("spectral: rgb, as it is off by "), std::string::npos) << text;
    EXPECT_NE(text.find("though lens cooke-triplet-50mm-f5 disperses\n"), std::string::npos);
    EXPECT_NE(text.find("dispersion: shared, as dispersion of cooke-triplet-50mm-f5 spreads "),
              std::string::npos)
        << text;
    EXPECT_EQ(text.find("spectral: wavelengths"), std::string::npos) << text;
    const io::Picture picture = io::read_picture(path("auto.exr"));
    static_cast<void>(
        said(lens({"--spectral", "rgb", "--method", "dispersion=shared"}), "asked.exr"));
    EXPECT_EQ(picture.pixels, io::read_picture(path("asked.exr")).pixels);
    EXPECT_NE(file_bytes(path("auto.exr")).find("petzval:plan"), std::string::npos);
    EXPECT_EQ(file_bytes(path("asked.exr")).find("petzval:plan"), std::string::npos);
}

TEST_F(AutoRender, KeepsWavelengthsApartWhereTheToleranceIsTight) {
    const std::string text = said(lens({"--tolerance", "0.001%"}), "auto.exr");
    EXPECT_NE(text.find("spectral: wavelengths, as lens cooke"), std::string::npos) << text;
    EXPECT_NE(text.find("dispersion: hero, as dispersion of "), std::string::npos) << text;
    static_cast<void>(said(lens({"--method", "dispersion=hero"}), "asked.exr"));
    EXPECT_EQ(io::read_picture(path("auto.exr")).pixels,
              io::read_picture(path("asked.exr")).pixels);
}

// An even sky has no noise but that of the weights: a hero ray's are uneven.
TEST_F(AutoRender, SplitsRaysWhereAHeroRayIsNoisier) {
    const Words sky = {
        "--lens",      "takumar-50mm-f1.2", "--focus",    "10",          "--background", "1,1,1",
        "--look-at",   "0,0,0,0,9,0.1",     "--size",     "600x400",     "--spp",        "1",
        "--tolerance", "0.0001%",           "--spectral", "wavelengths", "--crop",       "0,0,2,2"};
    const std::string text = said(sky);
    EXPECT_NE(text.find("dispersion: split, as dispersion of takumar"), std::string::npos) << text;
    EXPECT_NE(text.find("; to the same noise hero would take about "), std::string::npos) << text;
}

// Glints hold half of the variance in one look of three hundred: frames that show the same must not
// be told apart by them. Measured at length, split takes 2.2 times as long.
TEST_F(AutoRender, IsNotShakenByGlints) {
    for (const int width : {488, 504, 512}) {
        SceneRequest gem = request(PETZVAL_ASSETS "/scenes/gem.glb", {width, width * 2 / 3});
        gem.camera.lens = "takumar-50mm-f1.2";
        const RenderSetup setup = set_up_render(gem, kSilent);
        const ModeChoice found = choose_mode({gem, {}, {}}, setup, executor_);
        EXPECT_EQ(found.mode(), camera::DispersionMode::Hero) << width;
        EXPECT_GT(found.effort_of_next().value_or(0), 1.8) << width;
        EXPECT_LT(found.effort_of_next().value_or(0), 4.5) << width;
    }
}

TEST_F(AutoRender, SaysNothingOfNoiseWhereAllIsBlack) {
    Words dark = lens({"--look-at", "0,0,0,0,9,0.1", "--spectral", "wavelengths", "--tolerance",
                       "0.0001%", "--crop", "0,0,2,2"});
    dark[5] = "64x40";
    const std::string text = said(dark);
    EXPECT_NE(text.find("dispersion: hero, as dispersion of cooke"), std::string::npos) << text;
    EXPECT_EQ(text.find("noise"), std::string::npos) << text;
}

// So few looks cannot promise so much: nothing is rendered to learn that.
TEST_F(AutoRender, DoesNotLookWhereLooksCannotTell) {
    SceneRequest scene = tabletop({560, 360}, "cooke-triplet-50mm-f5");
    const AutoSetup loose = set_up_planned({scene, {}, {}, 0.1}, executor_, kSilent, {}),
                    tight = set_up_planned({scene, {}, {}, 1e-4}, executor_, kSilent, {});
    EXPECT_FALSE(loose.choice.candidates.empty());
    EXPECT_TRUE(tight.choice.candidates.empty());
    EXPECT_TRUE(tight.choice.measured_mode);
    EXPECT_TRUE(tight.setup.from.spectral.wavelengths);
}

// What is decided is a matter of the frame, not of the samples, the seed, the threads or the crop.
TEST_F(AutoRender, DecidesTheSameForEveryPartOfTheFrame) {
    const std::string whole = said(lens(), "whole.exr");
    for (const Words& more :
         {Words{"--crop", "10,20,3,2"}, Words{"--seed", "7"}, Words{"--threads", "1"}}) {
        Words words = lens(more);
        EXPECT_EQ(said(words, "part.exr"), whole) << more[0];
    }
    EXPECT_EQ(io::read_picture(path("part.exr")).pixels,
              io::read_picture(path("whole.exr")).pixels);
}

// No test of simpler models where there is nothing to decide, for a thumbnail, or where all was
// asked for.
TEST_F(AutoRender, LooksOnlyWhereItMust) {
    const auto piloted = [&](const Words& words) {
        static_cast<void>(said(words));
        return file_bytes(path("out.exr")).find("off by") != std::string::npos;
    };
    EXPECT_TRUE(piloted(lens({"--tolerance", "5%"})));
    Words small = lens({"--tolerance", "5%"});
    small[5] = "64x40";
    EXPECT_FALSE(piloted(small));
    EXPECT_FALSE(piloted(lens({"--spectral", "rgb"})));
    EXPECT_FALSE(piloted(lens({"--method", "dispersion=split"})));
    EXPECT_FALSE(piloted({"--fstop", "2", "--focus", "2", "--size", "500x320", "--spp", "1"}));
}

}  // namespace
}  // namespace petzval::apps
