// SPDX-License-Identifier: Apache-2.0
// petzval trace-sample: its text, and what it refuses.
#include <fmt/format.h>

#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

class CliTraceSample : public CliTest {
  protected:
    std::string trace(Words words) {
        words.insert(words.begin(), {"trace-sample", scene_, "--size", "16x16", "--quiet"});
        const Finished run = run_petzval(words);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.err, "");
        return run.out;
    }
};

// The last line has the numbers of a render of that sample alone.
TEST_F(CliTraceSample, EndsWithWhatARenderGives) {
    for (const Words& options : {Words{},
                                 {"--spectral", "wavelengths"},
                                 {"--camera", "tele"},
                                 {"--lens", "takumar-50mm-f1.2", "--focus", "1"}}) {
        Words words = options;
        words.insert(words.end(), {"--spp", "6:7"});
        const io::Picture p = render(words);
        for (const auto& [x, y] : {std::pair{3, 8}, {8, 8}, {0, 0}}) {
            Words traced = options;
            traced.push_back(fmt::format("{},{},6", x, y));
            const std::string out = trace(traced), begin = "\nthe film gets R,G,B ";
            const auto value = [&, x = x, y = y](const char* c) { return value_at(p, x, y, c); };
            EXPECT_EQ(out.substr(out.rfind(begin)),
                      fmt::format("{}{},{},{} nits, alpha {}\n", begin, value("R"), value("G"),
                                  value("B"), value("A")))
                << out;
        }
    }
}

TEST_F(CliTraceSample, NamesWhatAPathMeets) {
    TinyGltf file = studio();
    file.json["materials"][0]["name"] = "Plaster";
    scene_ = file.save_glb(path("named.glb")).string();
    const std::string out = trace({"--camera", "wide", "12,8,0"});
    for (const char* part :
         {"sample 0 of pixel 12,8: film point ",
          " px\nlanes: R, G, B; radiance in nits\npath 1, camera ray: from "
          "0,0,0 m "
          "towards ",
          "; weight on the film 1, 1, 1\n  meets front of material \"Plaster\" (mesh 0, "
          "instance 0, triangle ",
          " m on, at ", " m; throughput 1, 1, 1\n", "    samples light ",
          ": point\n    shadow ray to it, at ",
          " m away: a share of 1 comes through\n    scatters sampled light: + ",
          "    goes on, reflected (diffuse or wide lobe, ", "  ends: "})
        EXPECT_NE(out.find(part), std::string::npos) << out << "\nwithout: " << part;
    const std::string spectral = trace({"--spectral", "wavelengths", "12,8,0"});
    EXPECT_NE(spectral.find(" nm; radiance in W/(m² sr nm)\n"), std::string::npos) << spectral;
}

TEST_F(CliTraceSample, TellsOfTheLens) {
    // Wide open, the corner of the film loses some of what is sent to it.
    std::string all;
    for (int i = 0; i < 16; ++i)
        all += trace({"--lens", "takumar-50mm-f1.2", "--focus", "1", "--method", "dispersion=split",
                      fmt::format("0,0,{}", i)});
    EXPECT_NE(
        all.find("lens: 4 of 4 rays are lost: 4 at rims or the iris, 0 by total reflection, 0 "
                 "miss a surface, 0 do not reach their iris point\nthe film gets R,G,B 0,0,0 "
                 "nits, alpha 1\n"),
        std::string::npos)
        << all;
    EXPECT_NE(all.find("path 4, camera ray: "), std::string::npos) << all;
}

TEST_F(CliTraceSample, RefusesWhatIsNoSample) {
    const auto refused = [&](const std::string& wrong) {
        return error_of({"trace-sample", scene_, "--size", "16x16", wrong}, 2);
    };
    for (const char* wrong :
         {"16,0,0", "0,16,0", "3,4,-1", "3,-4,1", "1.5,2,3", "3,4,16777216", "3,4,1e30"})
        EXPECT_EQ(refused(wrong),
                  fmt::format("petzval: error: sample: \"{}\" is not x,y,index: a pixel of the "
                              "16x16 frame and the number of a sample, from 0 to 16777215 (--help "
                              "says more)",
                              wrong));
    for (const char* wrong : {"3,4", "3,4,5,6", "3,4,x", "nan,0,0"})
        EXPECT_EQ(refused(wrong),
                  fmt::format("petzval: error: sample: \"{}\" is not 3 numbers with commas "
                              "between them (--help says more)",
                              wrong));
    EXPECT_EQ(error_of({"trace-sample", scene_}, 2),
              "petzval: error: sample is required (--help says more)");
    EXPECT_EQ(error_of({"trace-sample", scene_, "0,0,0", "-o", path("a.exr")}, 2),
              "petzval: error: -o is no option of petzval trace-sample; petzval render has it "
              "(--help says more)");
    EXPECT_NE(error_of({"trace-sample", path("none.glb"), "0,0,0"}, 1).find("none.glb"),
              std::string::npos);
}

}  // namespace
}  // namespace petzval::apps
