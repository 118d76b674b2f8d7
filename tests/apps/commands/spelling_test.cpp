// SPDX-License-Identifier: Apache-2.0
// What is typed nearly right: spellings of values, options given twice, words that nothing knows.
#include <fmt/format.h>

#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

class CliSpelling : public CliTest {
  protected:
    /// The error of words that are refused, without what every such line has.
    std::string refused(const Words& words) {
        const std::string line = error_of(words, 2),
                          begin = "petzval: error: ", end = " (--help says more)";
        EXPECT_TRUE(line.ends_with(end)) << line;
        return line.substr(begin.size(), line.size() - begin.size() - end.size());
    }
    std::string refused_render(Words words) {
        words.insert(words.begin(), {"render", scene_, "-o", path("out.exr")});
        return refused(words);
    }
};

TEST_F(CliSpelling, ValuesMeanTheSameHoweverTheyAreSpelt) {
    const std::pair<Words, Words> pairs[] = {
        {{"--fstop", "f/2", "--focus", "150cm"}, {"--fstop", "2", "--focus", "1.5"}},
        {{"--fstop", "F2", "--focus", "∞"}, {"--fstop", "2", "--focus", "infinity"}},
        {{"--lens", "Thin", "--method", "lens-radius=2cm", "--focal-length", "5cm", "--focus", "1"},
         {"--lens", "thin", "--method", "lens-radius=0.02", "--focal-length", "50", "--focus",
          "1"}},
        {{"--fov", "40°", "--size", "16X16", "--method", "filter=Box", "--spp", "010"},
         {"--fov", "40", "--size", "16x16", "--method", "filter=box", "--spp", "10"}}};
    for (const auto& [as_typed, usual] : pairs)
        EXPECT_EQ(render_bytes(as_typed, "a.exr"), render_bytes(usual, "b.exr")) << as_typed[1];
}

TEST_F(CliSpelling, OfAnOptionGivenTwiceTheLastHolds) {
    EXPECT_EQ(render_bytes({"--seed", "3", "--view", "ACES", "--spp", "2", "--seed", "1", "--spp",
                            "4", "--method", "filter=gauss", "--method", "filter=box", "--quiet"},
                           "a.exr"),
              render_bytes({"--seed", "1", "--spp", "4", "--method", "filter=box"}, "b.exr"));
    EXPECT_EQ(render_bytes({"--method", "dispersion=split", "--lens", "takumar-50mm-f1.2",
                            "--focus", "1", "--method", "dispersion=shared"},
                           "a.exr"),
              render_bytes(
                  {"--lens", "takumar-50mm-f1.2", "--focus", "1", "--method", "dispersion=shared"},
                  "b.exr"));
    // What adds up still does.
    const io::Picture p = render({"--aov", "depth", "--aov", "albedo,depth"});
    EXPECT_GE(io::channel_index(p, "depth.Z"), 0);
    EXPECT_GE(io::channel_index(p, "albedo.R"), 0);
    // A plan's command has what holds, and only that.
    const Finished plan = run_petzval({"plan", scene_, "--size", "8x8", "--method", "max-depth=3",
                                       "--method", "max-depth=05", "--tolerance", "50%"});
    EXPECT_EQ(plan.exit_code, 0) << plan.err;
    EXPECT_NE(plan.out.find("--method max-depth=5"), std::string::npos) << plan.out;
    EXPECT_EQ(plan.out.find("--method max-depth=3"), std::string::npos) << plan.out;
}

TEST_F(CliSpelling, UnknownOptionsAreNamedAsTypedAndByWhatWasMeant) {
    EXPECT_EQ(refused_render({"--fokus", "1m"}),
              "--fokus is no option of petzval render; did you mean --focus?");
    EXPECT_EQ(refused_render({"--fokus=1m"}),
              "--fokus is no option of petzval render; did you mean --focus?");
    EXPECT_EQ(refused_render({"-spp", "4"}),
              "-spp is no option of petzval render; did you mean --spp?");
    EXPECT_EQ(refused_render({"--max_depth", "4"}),
              "--max_depth is no option of petzval render; did you mean --method max-depth?");
    EXPECT_EQ(refused_render({"--xyzzy"}), "--xyzzy is no option of petzval render");
    // Before what is missing, and before its value is taken for a scene.
    EXPECT_EQ(refused({"render", "--fokus", "1m", scene_}),
              "--fokus is no option of petzval render; did you mean --focus?");
    EXPECT_EQ(refused({"info", scene_, "--spp", "4"}),
              "--spp is no option of petzval info; petzval render has it");
    EXPECT_EQ(refused({"--versoin"}), "--versoin is no option of petzval; did you mean --version?");
}

// As in Blender, Cycles, Mitsuba and pbrt, and in cameras.
TEST_F(CliSpelling, OptionsOfOtherProgramsAreToldTheirNames) {
    const std::string size = " is no option of petzval render; type --size WIDTHxHEIGHT";
    for (const char* typed :
         {"--width", "--height", "--resolution", "--resolution-x", "--image_width"})
        EXPECT_EQ(refused_render({typed, "64"}), typed + size);
    EXPECT_EQ(refused({"plan", scene_, "--width=64"}),
              "--width is no option of petzval plan; type --size WIDTHxHEIGHT");
    const std::pair<const char*, const char*> now[] = {
        {"--max-bounces", "--method max-depth=NUMBER"},
        {"--hdri", "--env FILE"},
        {"--tone-mapping", "--view NAME"},
        {"--dof", "--fstop NUMBER --focus DISTANCE"},
        {"--ev", "--exposure STOPS"},
        {"--f-number", "--fstop NUMBER"},
        {"--format", "--output FILE, whose ending says the format"},
        {"--outfile", "--output FILE"}};
    for (const auto& [typed, option] : now)
        EXPECT_EQ(refused_render({typed, "1"}),
                  fmt::format("{} is no option of petzval render; type {}", typed, option));
    // Only where the command has it, and short words only as they stand.
    EXPECT_EQ(refused({"info", scene_, "--width", "4"}), "--width is no option of petzval info");
    EXPECT_EQ(refused_render({"--device", "gpu"}), "--device is no option of petzval render");
}

TEST_F(CliSpelling, OptionsOfOtherCommandsComeBeforeNearOnes) {
    EXPECT_EQ(refused({"plan", scene_, "-o", path("a.png")}),
              "-o is no option of petzval plan; petzval render has it");
    EXPECT_EQ(refused({"plan", scene_, "--progress", "json"}),
              "--progress is no option of petzval plan; petzval render has it");
    EXPECT_EQ(refused({"lens", "show", "--lens", "tessar-100mm-f2.8"}),
              "--lens is no option of petzval lens show; type the lens without it");
    EXPECT_EQ(refused({"image", "view", "--picture", path("a.exr"), "-o", path("a.png")}),
              "--picture is no option of petzval image view; type the picture without it");
    EXPECT_EQ(refused({"lens", "list", "--json"}),
              "--json is no option of petzval lens list; petzval lens check has it");
    // Of several words one, and no option that --help does not show.
    EXPECT_EQ(refused_render({"--depth", "4"}),
              "--depth is no option of petzval render; did you mean --method max-depth or "
              "--method max-clear-depth?");
    EXPECT_EQ(refused_render({"-q"}), "-q is no option of petzval render; did you mean --quiet?");
    EXPECT_EQ(refused_render({"-s", "4"}), "-s is no option of petzval render");
    EXPECT_EQ(refused_render({"--numbr", "4"}), "--numbr is no option of petzval render");
}

TEST_F(CliSpelling, MethodsHaveNamesAndValues) {
    EXPECT_EQ(refused_render({"--sampler", "owen"}),
              "--sampler is no option of petzval render; did you mean --method sampler?");
    EXPECT_EQ(refused_render({"--method", "sampler"}), "--method sampler: needs =VALUE");
    EXPECT_EQ(refused_render({"--method", "sampel=owen"}),
              "--method: \"sampel\" is none; did you mean sampler?");
    EXPECT_EQ(refused_render({"--method", "sampler=own"}),
              "--method sampler: \"own\" is none of owen, sobol, independent; did you mean owen?");
}

// Most people need few options, and one look shows them.
TEST_F(CliSpelling, HelpFitsAScreenAndHasAllWhereItIsAsked) {
    const std::string brief = run_petzval({"render", "--help"}).out;
    EXPECT_LE(std::count(brief.begin(), brief.end(), '\n'), 40);
    const std::string all = run_petzval({"render", "--help", "all"}).out;
    EXPECT_EQ(run_petzval({"help", "render", "all"}).out, all);
    EXPECT_EQ(run_petzval({"help", "render"}).out, brief);
    for (const char* option : {"--output", "--spp", "--lens"})
        EXPECT_NE(brief.find(option), std::string::npos) << option;
    for (const char* option : {"--iso", "--method", "iris-sampling"}) {
        EXPECT_EQ(brief.find(option), std::string::npos) << option;
        EXPECT_NE(all.find(option), std::string::npos) << option;
    }
}

TEST_F(CliSpelling, MisspeltCommandsAreFound) {
    EXPECT_EQ(refused({"rende"}), "\"rende\" is no command; did you mean render?");
    EXPECT_EQ(refused({"rende", scene_, "-o", path("a.png")}),
              "\"rende\" is no command; did you mean render?");
    EXPECT_EQ(refused({"lens", "shwo"}), "\"shwo\" is no command; did you mean show?");
    EXPECT_EQ(refused({"image", "blur"}),
              "\"blur\" is no command; there are petzval image diff, view, noise, spectrum");
    EXPECT_EQ(refused({"version"}), "\"version\" is no command; did you mean --version?");
    EXPECT_EQ(refused({}),
              "petzval needs a command: render, resume, merge, plan, chart, live, info, "
              "trace-sample, image, "
              "lens");
    EXPECT_EQ(refused({"image"}), "petzval image needs a command: diff, view, noise, spectrum");
    EXPECT_EQ(refused({"studio.glb"}),
              "\"studio.glb\" is no command; to render it type petzval render studio.glb -o "
              "studio.png, to see what is in it petzval info studio.glb");
    EXPECT_NE(refused({"my scene.GLTF", "-o", "a.png"})
                  .find("petzval render 'my scene.GLTF' -o 'my scene.png', to see what is in it "
                        "petzval info 'my scene.GLTF'"),
              std::string::npos);
    EXPECT_NE(refused({"it's.glb"}).find("render 'it'\\''s.glb' -o"), std::string::npos);
}

TEST_F(CliSpelling, NumbersInPlaceOfNamesAreToldTheirOption) {
    EXPECT_EQ(refused_render({"--lens", "50mm"}),
              "--lens: \"50mm\" is a length; type --lens thin --focal-length 50mm");
    EXPECT_EQ(refused_render({"--lens", "35"}),
              "--lens: \"35\" is a length; type --lens thin --focal-length 35");
    for (const char* text : {"2.8", "f/2.8", "F2.8", "1:2.8"})
        EXPECT_EQ(refused_render({"--aperture", text}),
                  "--aperture: 2.8 is an f-number and no shape; type --fstop 2.8");
}

TEST_F(CliSpelling, WordsWithoutAPlace) {
    EXPECT_EQ(refused({"render", scene_, path("out.png")}),
              "--output is required; did you mean -o " + path("out.png") + "?");
    EXPECT_EQ(refused({"info", scene_, "more"}), "petzval info has no place for \"more\"");
    EXPECT_EQ(refused({"render", scene_, "-o", path("out.exr"), "--spp"}), "--spp needs a value");
}

TEST_F(CliSpelling, HelpIsAWordToo) {
    const auto help = [&](const Words& words) {
        const Finished run = run_petzval(words);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.err, "");
        return run.out;
    };
    const std::string all = help({"help"}), spot = help({"help", "lens", "spot"});
    EXPECT_NE(all.find("render a glTF scene"), std::string::npos);
    EXPECT_EQ(all, help({"--help"}));
    EXPECT_EQ(spot, help({"lens", "spot", "--help"}));
    EXPECT_EQ(spot, help({"lens", "help", "spot"}));
    EXPECT_EQ(help({"lens", "help"}), help({"lens", "-h"}));
    EXPECT_NE(help({"--version"}).find("petzval 0"), std::string::npos);
    EXPECT_EQ(refused({"help", "rendr"}), "\"rendr\" is no command; did you mean render?");
}

TEST_F(CliSpelling, NearestNamesAreListed) {
    const std::pair<Words, std::string> cases[] = {
        {{"--lens", "takumar", "--focus", "1"},
         "takumar: is neither a file nor a lens; did you mean takumar-50mm-f1.2?"},
        {{"--camera", "wied"}, "did you mean wide?"},
        {{"--view", "ACSE"},
         "--view: Petzval's configuration: there is no view \"ACSE\"; there are sRGB, ACES, raw; "
         "did you mean ACES?"},
        {{"--method", "filter=blackman"}, "did you mean blackman-harris?"},
        {{"--aov", "albdeo"}, "did you mean albedo?"},
        {{"--fstop", "2", "--focus", "1", "--aperture", "squar"}, "did you mean square?"},
        {{"--illuminant", "d56"}, "the names are d65, a, f11; did you mean d65?"},
        {{"--lens", "singlet:schott:N-BK77", "--fstop", "4"}, "schott:N-BK7"},
        {{"--exposure-mode", "normalized"}, "did you mean normalised?"}};
    std::vector<Case> refusals;
    for (const auto& [words, part] : cases) refusals.push_back({words, part});
    expect_refused(2, refusals);
    const std::string unknown = error_of({"lens", "show", "summicron"}, 2);
    EXPECT_NE(unknown.find("the lenses are"), std::string::npos) << unknown;
}

TEST_F(CliSpelling, OtherFormatsOfScenesAreToldWhatIsRead) {
    for (const char* name : {"a.usd", "b.USDZ", "c.obj", "d.fbx", "e.blend", "f.stl"}) {
        const std::string file = text_file(name, "# something");
        const std::string line = error_of({"render", file, "-o", path("out.exr")}, 1);
        EXPECT_TRUE(line.starts_with("petzval: error: " + file + ": is a file of ")) << line;
        EXPECT_NE(line.find("scenes are read as glTF 2.0"), std::string::npos) << line;
        EXPECT_NE(line.find("File > Export"), std::string::npos) << line;
    }
    EXPECT_NE(error_of({"info", text_file("a.max", "x")}, 1).find("3ds Max"), std::string::npos);
    EXPECT_NE(refused({"model.fbx"}).find("model.fbx: is a file of FBX"), std::string::npos);
}

// The last holds of most options, but an output that is left out would be lost without a word.
TEST_F(CliSpelling, NoOutputIsLostWhereTwoAreGiven) {
    const Words words[] = {
        {"image", "view", path("a.exr"), "-o", path("b.png"), "-o", path("c.png")},
        {"lens", "spot", "tessar-100mm-f2.8", "-o", path("b.svg"), "-o", path("c.svg")},
        {"lens", "draw", "tessar-100mm-f2.8", "-o", path("b.svg"), "-o", path("c.svg")}};
    for (const Words& one : words)
        EXPECT_NE(error_of(one, 2).find("--output is given twice"), std::string::npos) << one[1];
}

}  // namespace
}  // namespace petzval::apps
