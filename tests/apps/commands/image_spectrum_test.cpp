// SPDX-License-Identifier: Apache-2.0
// petzval image with spectral pictures.
#include "io/image/picture_files.h"
#include "io/image/spectral_layout.h"
#include "tests/support/cli.h"
#include "tests/support/pictures.h"

namespace petzval::apps {
namespace {

class CliSpectrum : public CliTest {
  protected:
    /// A crop of 3 x 2 pixels from 4,5 with R, G, B and these wavelengths.
    std::string spectral(const std::string& name, const std::vector<double>& wavelengths_nm,
                         std::vector<std::string> channels = {"R", "G", "B"}) {
        for (const double nm : wavelengths_nm) channels.push_back(io::spectral_channel(nm));
        io::Picture p = test::picture(3, 2, std::move(channels));
        p.x = 4;
        p.y = 5;
        p.full_width = p.full_height = 10;
        for (size_t i = 0; i < p.pixels.size(); ++i) p.pixels[i] = float(i) / 8;
        io::write_exr(path(name), p);
        return path(name);
    }
};

TEST_F(CliSpectrum, PrintsThePixelsBins) {
    // Channels out of order, and one of five digits.
    const std::string file = spectral("a.exr", {1005, 385, 390.25});
    const Finished run = run_petzval({"image", "spectrum", file, "5,6"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    // Pixel 1,1 of the crop, six channels each: values from (3 + 1) * 6 / 8.
    EXPECT_EQ(run.out, "385 3.5\n390.25 3.625\n1005 3.375\n");
}

// A file of another program, with a denoised value for one of its bins.
TEST_F(CliSpectrum, PairsDenoisedBinsByTheirWavelengths) {
    const std::string file =
        spectral("a.exr", {385, 395}, {"R", "G", "B", "denoised." + io::spectral_channel(395)});
    const Finished run = run_petzval({"image", "spectrum", file, "5,6"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, "385 3.5\n395 3.625 3.375\n");
}

TEST_F(CliSpectrum, PlotsThePixelsBins) {
    const std::string file = spectral("it's_a.exr", {385, 395, 405});
    for (const char* name : {"plot.svg", "plot.png"}) {
        const Finished run = run_petzval({"image", "spectrum", file, "4,5", "-o", path(name)});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.out, "385 0.375\n395 0.5\n405 0.625\n");
    }
    EXPECT_EQ(io::read_picture(path("plot.png")).width, 960);
    const std::string svg = file_bytes(path("plot.svg"));
    for (const char* text : {"pixel 4,5 of ", "it's_a.exr", "wavelength (nm)", "W m⁻² sr⁻¹ nm⁻¹"})
        EXPECT_NE(svg.find(text), std::string::npos) << text;
}

TEST_F(CliSpectrum, RefusesWhatIsNotThere) {
    const std::string file = spectral("a.exr", {385, 395}), rgb = spectral("rgb.exr", {});
    const auto spectrum = [&](const std::string& in, const std::string& at, const Words& more = {},
                              int exit_code = 2) {
        Words words = {"image", "spectrum", in, at};
        words.insert(words.end(), more.begin(), more.end());
        return error_of(words, exit_code);
    };
    for (const char* at : {"3,5", "4,4", "7,5", "4,7"})
        EXPECT_NE(spectrum(file, at).find("a.exr: has no pixel " + std::string(at) +
                                          "; it has 4,5 to 6,6"),
                  std::string::npos);
    const std::string no = spectrum(rgb, "4,5");
    EXPECT_NE(no.find("rgb.exr: is not spectral"), std::string::npos) << no;
    EXPECT_NE(no.find("render with --bins"), std::string::npos) << no;
    for (const char* at : {"4", "4,5,6", "4.5,5", "a,b"})
        EXPECT_NE(spectrum(file, at).find("a pixel x,y"), std::string::npos);
    EXPECT_NE(spectrum(path("none.exr"), "4,5", {}, 1).find("none.exr"), std::string::npos);
    EXPECT_NE(spectrum(file, "4,5", {"-o", path("a.pdf")}, 2).find(".svg or .png"),
              std::string::npos);
    EXPECT_NE(spectrum(file, "4,5", {"-o", path("none/a.svg")}, 3).find("none/a.svg"),
              std::string::npos);
}

TEST_F(CliSpectrum, DiffComparesTheBinsAsOneLayer) {
    const std::string a = spectral("a.exr", {385, 395, 405}),
                      b = spectral("b.exr", {385, 395, 405});
    io::Picture p = io::read_picture(b);
    // Each pixel's 395 nm by one more; then one more still in the last pixel.
    const size_t at = size_t(io::channel_index(p, "S0.395,0nm"));
    for (size_t i = 0; i < 6; ++i) p.pixels[i * p.channels.size() + at] += i == 5 ? 2.f : 1.f;
    io::write_exr(b, p);
    const Finished run = run_petzval({"image", "diff", a, b});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("RGB: symmetric MSE 0, RMSE 0,"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("\nS0: RMSE 0.707107,"), std::string::npos) << run.out;  // sqrt(9 / 18)
    EXPECT_NE(run.out.find("max 2 in S0.395,0nm at 6,6\n"), std::string::npos) << run.out;
    EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 2) << run.out;
    EXPECT_EQ(run_petzval({"image", "diff", a, b, "--fail-above", "0.7"}).exit_code, 1);
    EXPECT_EQ(run_petzval({"image", "diff", a, b, "--fail-above", "0.71"}).exit_code, 0);
}

TEST_F(CliSpectrum, DiffSaysWhatIsNotTheSame) {
    const std::string a = spectral("a.exr", {385, 395, 405}), rgb = spectral("rgb.exr", {});
    const auto diff = [&](const std::string& one, const std::string& two) {
        return error_of({"image", "diff", one, two}, 1);
    };
    EXPECT_NE(diff(a, rgb).find("a.exr: differs in kind from " + rgb +
                                ": the former is spectral, the latter is not"),
              std::string::npos);
    EXPECT_NE(diff(rgb, a).find("rgb.exr: differs in kind from " + a +
                                ": the latter is spectral, the former is not"),
              std::string::npos);
    EXPECT_NE(diff(a, spectral("b.exr", {385, 397.5, 410}))
                  .find("wavelength 2 is 395 nm against 397.5 nm"),
              std::string::npos);
    EXPECT_NE(diff(a, spectral("c.exr", {385, 395}))
                  .find("3 wavelengths, up to 405 nm, against 2, up to 395 nm"),
              std::string::npos);
    const std::string other = spectral("d.exr", {385, 395, 405}, {"R", "G", "Y"}),
                      only = "channels only in the former: B; only in the latter: Y";
    EXPECT_NE(run_petzval({"image", "diff", a, other}).out.find("not compared: " + only),
              std::string::npos);
    const Finished above = run_petzval({"image", "diff", a, other, "--fail-above", "1e30"});
    EXPECT_EQ(above.exit_code, 1);
    EXPECT_NE(above.err.find(only), std::string::npos);
}

}  // namespace
}  // namespace petzval::apps
