// SPDX-License-Identifier: Apache-2.0
// What petzval image diff prints.
#include "tests/support/cli.h"
#include "tests/support/pictures.h"

namespace petzval::apps {
namespace {

class CliImageDiff : public CliTest {
  protected:
    /// One pixel of R, G, B and a depth.
    std::string one_pixel(const std::string& name, float grey, float depth) {
        io::write_exr(path(name),
                      test::picture(1, 1, {"R", "G", "B", "depth.Z"}, {grey, grey, grey, depth}));
        return path(name);
    }
};

TEST_F(CliImageDiff, PrintsTheErrorsOfEachLayer) {
    const std::string a = one_pixel("a.exr", 0.f, 3.f), b = one_pixel("b.exr", 2.f, 4.f);
    const Finished run = run_petzval({"image", "diff", a, b});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    // The floor is 0.5: 4 / (4 / 2 + 0.25).
    EXPECT_EQ(run.out.find("RGB: symmetric MSE 1.77778, RMSE 2, relative MSE 0.997506, PSNR"), 0u)
        << run.out;
    EXPECT_NE(run.out.find("\ndepth: RMSE 1, relative MSE 0.062461, PSNR"), std::string::npos)
        << run.out;
    // The other way round the reference is black, which has no floor.
    EXPECT_EQ(run_petzval({"image", "diff", b, a}).out.find("RGB: symmetric MSE 2, RMSE 2,"), 0u);
}

TEST_F(CliImageDiff, HelpSaysWhatTheErrorsAre) {
    const std::string help = run_petzval({"image", "diff", "--help"}).out;
    std::string words;  // without the breaks of lines
    for (const char c : help)
        if (c != '\n' && c != ' ') words += c;
    for (const char* text : {"meanof(a-b)^2/((a^2+b^2)/2+f^2),wherefis0.25timesthereference's",
                             "meanof(a-b)^2/(b^2+0.01)"})
        EXPECT_NE(words.find(text), std::string::npos) << help;
}

}  // namespace
}  // namespace petzval::apps
