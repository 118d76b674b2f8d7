// SPDX-License-Identifier: Apache-2.0
// Materials of measured reflectances: 24 patches of a chart against the integrals of their curves,
// and files of a scene's own.
#include <cmath>

#include "core/spectrum/metal.h"
#include "tests/support/cli_spectral.h"

namespace petzval::apps {
namespace {

/// Patches of 10 x 10 pixels in the order of the chart.
constexpr int kColumns = 6, kRows = 4, kSide = 10;
const std::string kSize = std::to_string(kColumns * kSide) + "x" + std::to_string(kRows * kSide);

class ReflectanceCli : public CliSpectral {
  protected:
    /// A chart of diffuse patches before an even sky; more: what each material has beside.
    static TinyGltf chart(const json& more = json::object()) {
        TinyGltf file;
        const std::vector<std::string> names = io::reflectance_names();
        for (int i = 0; i < kColumns * kRows; ++i) {
            const auto x = float(i % kColumns), y = float(-i / kColumns);
            add_wall(file, x, y - 1, x + 1, y, -1, {1, 1, 1});
            json& material = file.json["materials"].back();
            material["extras"]["petzval"]["reflectance"] = names[size_t(i)];
            material.update(more, true);
        }
        const int camera = file.add(
            "cameras",
            {{"type", "orthographic"},
             {"orthographic",
              {{"xmag", kColumns / 2.}, {"ymag", kRows / 2.}, {"znear", 0.1}, {"zfar", 10}}}});
        file.add_root({{"camera", camera}, {"translation", {kColumns / 2., -kRows / 2., 0}}});
        return file;
    }
    /// Means of the patches, two pixels off their edges: the pixel filter reaches so far.
    std::vector<V3d> patches(Words words) {
        words.insert(words.end(), {"--size", kSize, "--background", "1,1,1"});
        const io::Picture p = render(words);
        std::vector<V3d> means;
        for (int i = 0; i < kColumns * kRows; ++i) {
            V3d sum(0.);
            for (int y = 2; y < kSide - 2; ++y)
                for (int x = 2; x < kSide - 2; ++x)
                    for (int k = 0; k < 3; ++k)
                        sum[k] += value_at(p, i % kColumns * kSide + x, i / kColumns * kSide + y,
                                           std::string("RGB").substr(size_t(k), 1));
            means.push_back(sum / double((kSide - 4) * (kSide - 4)));
        }
        return means;
    }
    /// Linear sRGB of each curve under 1 nit of an illuminant: integrals at 1 nm.
    static std::vector<V3d> integrals(const char* illuminant) {
        const auto bar = io::standard_observer();
        const SpectrumTable light = io::find_illuminant(illuminant);
        const V3d d65 = respond(bar, io::find_illuminant("d65"));
        const Matrix3 to_srgb = srgb_to_xyz(d65 / d65.y).inverse();
        const double nit = respond(bar, light).y;
        std::vector<V3d> all;
        for (const SpectrumTable& curve : io::training_reflectances()) {
            V3d xyz(0.);
            for (int nm = kFirst_nm; nm <= kLast_nm; ++nm)
                for (int k = 0; k < 3; ++k)
                    xyz[k] += double(curve.at_nm(nm)) * light.at_nm(nm) * bar[size_t(k)].at_nm(nm);
            all.push_back(to_srgb * (xyz / nit));
        }
        return all;
    }
    static void expect_near(const std::vector<V3d>& found, const std::vector<V3d>& expected,
                            double tolerance) {
        ASSERT_EQ(found.size(), expected.size());
        const std::vector<std::string> names = io::reflectance_names();
        for (size_t i = 0; i < found.size(); ++i)
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(found[i][k], expected[i][k], tolerance) << names[i] << ' ' << "RGB"[k];
    }
};

// An even sky of 1 nit over flat patches: their light is the curve times the sky's.
TEST_F(ReflectanceCli, PatchesAreTheIntegralsOfTheirCurves) {
    use(chart());
    for (const char* illuminant : {"d65", "a"})
        expect_near(patches({"--illuminant", illuminant, "--spp", "256"}), integrals(illuminant),
                    0.0005);
}

TEST_F(ReflectanceCli, InRgbPatchesHaveTheColourUnderD65) {
    use(chart());
    std::vector<V3d> expected = integrals("d65");
    for (V3d& c : expected)
        for (int k = 0; k < 3; ++k) c[k] = std::clamp(c[k], 0., 1.);
    expect_near(patches({"--spectral", "rgb"}), expected, 1e-4);
}

// A metal has no other reflectance than that at normal incidence, but towards grazing angles.
TEST_F(ReflectanceCli, OnAMetalItIsThatAtNormalIncidence) {
    use(chart({{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}},
               {"extensions", json::object()}}));
    expect_near(patches({"--illuminant", "a", "--spp", "256"}), integrals("a"), 0.0005);
}

// Rows may come in any order; another file of that name is another scene.
TEST_F(ReflectanceCli, AFileIsReadAndNotOverwrittenAndAPartOfWhatIsRendered) {
    use(big_wall(extras("reflectance", "Paint 1%.csv")));
    text_file("Paint 1%.csv", "\xEF\xBB\xBFnm,r\r\n700,0.2\r\n400,0.8\r\n");  // red first
    const Words words = {"--background", "1,1,1", "--spp", "64", "--bins", "400:700:100"};
    const io::Picture p = render(words);
    EXPECT_EQ(said({"--background", "1,1,1"}),
              "petzval: spectral: wavelengths, as a material without a name has a measured "
              "reflectance (Paint 1%.csv)\n");
    EXPECT_NE(run_petzval({"info", scene_}).out.find("measured reflectance Paint 1%.csv"),
              std::string::npos);
    const SpectrumTable light = io::find_illuminant("d65");
    const double nit = 683.002 * integral_of_product(io::standard_observer()[1], light);
    for (const auto& [bin, first_nm] : {std::pair{"S0.450,0nm", 400}, {"S0.650,0nm", 600}}) {
        double mean = 0;
        for (int nm = first_nm; nm < first_nm + 100; ++nm)
            mean += (0.8 - 0.002 * (nm + 0.5 - 400)) * light.at(float(nm) + 0.5f) / nit / 100;
        EXPECT_NEAR(mean_of(p, bin) / mean, 1, 0.01) << bin;
    }
    const std::string hash = metadata_of(p, "petzval:sceneHash");
    EXPECT_NE(hash, "(none)");
    text_file("Paint 1%.csv", "nm,r\n400,0.5\n");
    const io::Picture grey = render({"--background", "1,1,1", "--spp", "64"});
    for (const char* c : {"R", "G", "B"}) EXPECT_NEAR(mean_of(grey, c), 0.5, 0.003) << c;
    EXPECT_NE(metadata_of(grey, "petzval:sceneHash"), hash);
    use(big_wall(extras("reflectance", "paint.png")));
    const std::string paint = text_file("paint.png", "nm,r\n400,0.5\n");
    const std::string line = error_of({"render", scene_, "--quiet", "-o", paint}, 2);
    EXPECT_NE(line.find("-o would overwrite a file of the scene"), std::string::npos) << line;
}

TEST_F(ReflectanceCli, AFileLiesInTheFolderOfTheScene) {
    std::filesystem::create_directory(path("scene"));
    text_file("paint.csv", "nm,r\n500,0.5\n");
    text_file("scene/paint.csv", "nm,r\n500,0.5\n");
    const auto render_of = [&](const std::string& name, Words words) {
        const TinyGltf file = big_wall(extras("reflectance", name.c_str()));
        words.insert(words.end(), {"--quiet", "-o", path("o.exr")});
        return run_petzval(
            render_words(words, file.save_glb(folder_.path / "scene/s.glb").string()));
    };
    const std::string place = "s.glb: /materials/0/extras/petzval/reflectance: ";
    EXPECT_EQ(render_of("paint.csv", {"--confine"}).err, "");
    EXPECT_EQ(render_of("ColorChecker:Cyan", {"--confine"}).err, "");
    EXPECT_EQ(render_of("../paint.csv", {}).err, "");
    const Finished out = render_of("../paint.csv", {"--confine"});
    EXPECT_EQ(out.exit_code, 1);
    EXPECT_NE(out.err.find(place + "\"../paint.csv\" lies outside the folder of the scene"),
              std::string::npos)
        << out.err;
    EXPECT_NE(render_of(path("paint.csv"), {}).err.find("is neither a name nor a relative path"),
              std::string::npos);
}

}  // namespace
}  // namespace petzval::apps
