// SPDX-License-Identifier: Apache-2.0
// What petzval render with wavelengths refuses.
#include <array>
#include <cmath>

#include "tests/support/cli_spectral.h"

namespace petzval::apps {
namespace {

class CliSpectralErrors : public CliSpectral {};

TEST_F(CliSpectralErrors, BinsThatAreNone) {
    use(lamp());
    const std::string inside = "inside 360 to 830 nm", whole = "a whole number of bins",
                      rising = "FIRST must be below LAST", form = "FIRST:LAST:WIDTH in nm",
                      wide = "1 to 1024 bins of at least 0.1 nm";
    std::vector<Case> cases;
    for (const auto& [bins, part] : std::vector<std::pair<std::string, std::string>>{
             {"350:730:10", inside},
             {"730:380:10", rising},
             {"380:730:11", whole},
             {"500:501:0.01", wide},
             {"380:730:nan", form},
             {"", "--bins: \"\" is not FIRST:LAST:WIDTH in nm"}})
        cases.push_back({{"--bins", bins, "--spp", "8"}, part});
    expect_refused(2, cases);
}

TEST_F(CliSpectralErrors, OptionsThatDoNotGoTogether) {
    use(mixed());
    const Words bins = {"--bins", "380:730:10"};
    const auto with = [&](const Words& more) {
        Words words = bins;
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    expect_refused(
        2, {{with({"--spp", "7"}), "--spp: the standard errors of --bins need at least 8"},
            {with({"--spectral", "rgb", "--spp", "8"}), "--bins: needs wavelengths"},
            {with({"--spp", "8", "-o", path("out.png")}), "--bins: needs an output"},
            {{"--bins", "360:830:10", "--spp", "8"}, "glass schott:N-SF11 is known from 370 to"},
            {{"--spectral", "full"}, "auto, rgb, wavelengths"},
            {{"--method", "white-balance=a"}, "none, illuminant"},
            {{"--illuminant", path("none.csv")}, "none.csv: is neither a file nor a name; the"},
            {{"--illuminant", "d50"}, "the names are d65, a, f11"},
            {{"--illuminant", ""}, "--illuminant: is empty"},
            {{"--response", "canon"}, "the names are cie1931"},
            {{"--response", ""}, "--response: is empty"}});
}

TEST_F(CliSpectralErrors, FilesThatAreNotAsTheyShouldBe) {
    use(lamp());
    const auto gauss = [](int nm, double centre) {
        return std::exp(-std::pow((nm - centre) / 30, 2));
    };
    const std::string equal = csv("equal.csv", [&](int nm) -> std::vector<double> {
        return {gauss(nm, 600), gauss(nm, 450), gauss(nm, 450)};
    });
    const std::string blank = csv("blank.csv", [&](int nm) -> std::vector<double> {
        return {gauss(nm, 600), 0, gauss(nm, 450)};
    });
    const auto light = [&](const std::string& name, const std::string& text,
                           const std::string& part) {
        return Case{{"--illuminant", text_file(name, text)}, name + ": " + part};
    };
    expect_refused(
        1, {light("empty.csv", "", "is empty"),
            light("names.csv", "nm,v", "line 1: ends without a row"),
            light("unsorted.csv", "nm,v\n500,1\n500,1\n", "line 3: wavelength 500 nm must be"),
            light("missing.csv", "nm,v\n500\n", "line 2: number of columns is 1, and 2"),
            light("dark.csv", "nm,v\n400,0\n700,0\n", "line 2: column v is 0 at every"),
            {{"--illuminant", folder_.path.string()}, "is a folder"},
            {{"--illuminant", equal}, "number of columns is 4 and must be 2"},
            {{"--response", equal}, "the three curves do not tell three colours apart"},
            {{"--response", blank}, "column curve1 is 0 at every"}});
    std::vector<Case> scenes;
    for (const auto& [key, name, part] : std::vector<std::array<const char*, 3>>{
             {"glass", "schott:BK77", "there is no glass \"schott:BK77\"; near are schott:"},
             {"metal", "fe", "there is no metal \"fe\"; there are ag, al, au, cu"},
             {"illuminant", "d50", "there is no illuminant \"d50\"; there are d65, a, f11"}}) {
        const auto file =
            lamp(extras(key, name)).save_glb(folder_.path / (key + std::string("s.glb")));
        scenes.push_back({{"render", file.string(), "--size", "4x4"}, part});
    }
    expect_refused(1, scenes);
}

TEST_F(CliSpectralErrors, ASpectralFileAgainstAnRgbOne) {
    use(lamp());
    (void)render({}, "rgb.exr");
    (void)render({"--bins", "400:700:100", "--spp", "8"}, "bins.exr");
    const Finished run = run_petzval({"image", "diff", path("bins.exr"), path("rgb.exr")});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.err.find("the former is spectral, the latter is not"), std::string::npos)
        << run.err;
}

}  // namespace
}  // namespace petzval::apps
