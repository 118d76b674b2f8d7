// SPDX-License-Identifier: Apache-2.0
// A film with bins, filled by hand, as a file: read back by OpenImageIO channel by channel.
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cfloat>
#include <map>

#include "apps/setup/develop.h"
#include "io/base/error.h"
#include "io/image/picture_files.h"
#include "io/image/spectral_layout.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

namespace petzval::apps {
namespace {

using test::read_bytes;
using test::TemporaryFolder;

constexpr Bins kBins{380, 10, 35};

/// What the samples of a pixel say, the same at each sample but for `spread` in red.
struct Light {
    V3f rgb, xyz;
    float bin_5, bin_20, spread;
};
Light light_of(int x, int y) {
    const auto a = float(x), b = float(y);
    return {{a + 1, b + 2, 3}, {a, 10 + b, 0.5f}, 0.25f + a, 7 + b, 0.125f * a};
}

/// One sample with two lanes on, in bins 5 (435 nm) and 20 (585 nm).
void add_sample(Film& film, int x, int y, uint32_t index, const Light& light) {
    Bands bands = Bands::rgb();
    bands.nm = f4{431, 589, 0, 0};
    bands.pdf = f4{0.5f, 0.25f, 1, 1};
    bands.on = m4{-1, -1, 0, 0};
    // Of a lane's radiance: divided by density, lanes and width of the bin.
    const f4 radiance{light.bin_5 * 0.5f * 2 * 10, light.bin_20 * 0.25f * 2 * 10, 0, 0};
    FilmSample sample;
    const float red = light.rgb.x + (index % 2 == 0 ? light.spread : -light.spread);
    sample.colour = Rgb(red, light.rgb.y, light.rgb.z);
    sample.alpha = 0.5f;
    sample.hit = true;
    sample.aov[static_cast<size_t>(Aov::Depth)] = V3f(float(100 + x), 0, 0);
    film.add(x, y, index, sample, {index % kReplicates, radiance, light.xyz}, bands);
}

Film filled(Rect crop, uint32_t samples) {
    Film film({9, 40}, crop, {Aov::Depth}, kBins);
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x)
            for (uint32_t i = 0; i < samples; ++i) add_sample(film, x, y, i, light_of(x, y));
    return film;
}

io::PictureRows developed(const Film& film, uint32_t samples) {
    return develop(
        film, {0, samples},
        describe_render(RenderSetup{}, integrator::RenderJob{}, integrator::PathOptions{}));
}

/// One channel of a file by name, through an OpenImageIO reader of its own.
std::vector<float> channel_of(const std::filesystem::path& path, const std::string& name) {
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) throw std::runtime_error(OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();
    const int c = spec.channelindex(name);
    EXPECT_GE(c, 0) << name;
    EXPECT_EQ(spec.channelformat(c), OIIO::TypeDesc::FLOAT);
    std::vector<float> values(size_t(spec.width) * size_t(spec.height));
    EXPECT_TRUE(input->read_image(0, 0, c, c + 1, OIIO::TypeDesc::FLOAT, values.data()));
    return values;
}

void expect_layer(const std::filesystem::path& path, const std::string& name, Rect crop,
                  const std::function<float(const Light&)>& value) {
    const std::vector<float> values = channel_of(path, name);
    ASSERT_EQ(values.size(), size_t(crop.width()) * size_t(crop.height()));
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x)
            ASSERT_FLOAT_EQ(
                values[size_t(y - crop.y0) * size_t(crop.width()) + size_t(x - crop.x0)],
                value(light_of(x, y)))
                << name << " at " << x << "," << y;
}

// A crop of more rows than are packed at once, off the frame's corner.
constexpr Rect kCrop{2, 3, 7, 39};

TEST(SpectralExr, HoldsEveryChannelOfTheFilm) {
    const TemporaryFolder folder;
    const auto path = folder / "a.exr";
    io::write_exr(path, developed(filled(kCrop, 16), 16));

    const auto input = OIIO::ImageInput::open(path.string());
    ASSERT_TRUE(input);
    const OIIO::ImageSpec& spec = input->spec();
    EXPECT_EQ(spec.nchannels, 4 + 35 + 3 + 3 + 1);
    EXPECT_EQ(V2i(spec.x, spec.y), V2i(2, 3));
    EXPECT_EQ(V2i(spec.width, spec.height), V2i(5, 36));
    EXPECT_EQ(V2i(spec.full_width, spec.full_height), V2i(9, 40));

    expect_layer(path, "R", kCrop, [](const Light& l) { return l.rgb.x; });
    expect_layer(path, "G", kCrop, [](const Light& l) { return l.rgb.y; });
    expect_layer(path, "B", kCrop, [](const Light& l) { return l.rgb.z; });
    expect_layer(path, "A", kCrop, [](const Light&) { return 0.5f; });
    for (int i = 0; i < 35; ++i)
        expect_layer(path, "S0." + std::to_string(385 + 10 * i) + ",0nm", kCrop,
                     [&](const Light& l) { return i == 5    ? l.bin_5
                                                  : i == 20 ? l.bin_20
                                                            : 0.f; });
    expect_layer(path, "XYZ.X", kCrop, [](const Light& l) { return l.xyz.x; });
    expect_layer(path, "XYZ.Y", kCrop, [](const Light& l) { return l.xyz.y; });
    expect_layer(path, "XYZ.Z", kCrop, [](const Light& l) { return l.xyz.z; });
    // Eight means, four at +s and four at -s: sqrt(8 s^2 / (8 * 7)).
    expect_layer(path, "stderr.R", kCrop, [](const Light& l) { return l.spread / std::sqrt(7.f); });
    expect_layer(path, "stderr.G", kCrop, [](const Light&) { return 0.f; });
    expect_layer(path, "stderr.B", kCrop, [](const Light&) { return 0.f; });
    expect_layer(path, "depth.Z", kCrop, [](const Light& l) { return l.rgb.x + 99; });
}

TEST(SpectralExr, SaysWhatTheNumbersMean) {
    const TemporaryFolder folder;
    const Rect crop{1, 0, 3, 1};
    io::write_exr(folder / "a.exr", developed(filled(crop, 16), 16));
    const auto input = OIIO::ImageInput::open((folder / "a.exr").string());
    ASSERT_TRUE(input);
    const auto text = [&](const char* name) {
        return std::string(input->spec().get_string_attribute(name));
    };
    EXPECT_EQ(text("spectralLayoutVersion"), "1.0");
    EXPECT_EQ(text("emissiveUnits"), "W.m^-2.sr^-1");
    EXPECT_EQ(text("petzval:bins"), "380:730:10");
    EXPECT_NE(text("petzval:binScale").find("W.m^-2.sr^-1.nm^-1"), std::string::npos);
    EXPECT_EQ(input->spec().get_int_attribute("petzval:replicates"), 8);
    double sum = 0;  // of red's share in luminance times its error
    for (const int x : {1, 2}) {
        const Light l = light_of(x, 0);
        sum += luminance(Rgb(l.spread / std::sqrt(7.f), 0, 0)) /
               luminance(Rgb(l.rgb.x, l.rgb.y, l.rgb.z));
    }
    EXPECT_FLOAT_EQ(input->spec().get_float_attribute("petzval:meanRelativeError"), float(sum / 2));
}

TEST(SpectralExr, UnknownErrorsAreTheLargestFloatAndHaveNoMean) {
    const TemporaryFolder folder;
    io::write_exr(folder / "a.exr", developed(filled(kCrop, 7), 7));
    for (const float error : channel_of(folder / "a.exr", "stderr.R")) EXPECT_EQ(error, FLT_MAX);
    const auto input = OIIO::ImageInput::open((folder / "a.exr").string());
    EXPECT_EQ(input->spec().find_attribute("petzval:meanRelativeError"), nullptr);
}

TEST(SpectralExr, NoBinsNoSpectralLayout) {
    const TemporaryFolder folder;
    const Film film({2, 2}, {0, 0, 2, 2}, {});
    io::write_exr(folder / "a.exr", developed(film, 0));
    const io::Picture p = io::read_picture(folder / "a.exr");
    EXPECT_EQ(p.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    for (const auto& [name, value] : p.metadata) EXPECT_NE(name, "spectralLayoutVersion");
    EXPECT_TRUE(io::spectral_channels(p).empty());
}

TEST(SpectralExr, EqualFilmsAreEqualFiles) {
    const TemporaryFolder folder;
    const Film film = filled(kCrop, 9);
    io::write_exr(folder / "a.exr", developed(film, 9));
    io::write_exr(folder / "b.exr", developed(filled(kCrop, 9), 9));
    EXPECT_EQ(read_bytes(folder / "a.exr"), read_bytes(folder / "b.exr"));
}

TEST(SpectralExr, AFullDiskLeavesTheOldFile) {
    const TemporaryFolder folder;
    const Film film = filled(kCrop, 9);
    const auto path = folder / "a.exr";
    io::write_exr(path, developed(film, 9));
    const size_t whole = read_bytes(path).size();
    test::write_bytes(path, {'o', 'l', 'd'});
    // In the header, among the pixels, and at the last byte.
    for (const size_t bytes : {size_t{100}, whole / 2, whole - 1}) {
        const test::FileSizeLimit limit(bytes);
        EXPECT_THROW(io::write_exr(path, developed(film, 9)), io::InputError) << bytes;
    }
    EXPECT_EQ(read_bytes(path), (std::vector<uint8_t>{'o', 'l', 'd'}));
    EXPECT_EQ(folder.count(), 1u);
    EXPECT_THROW(io::write_exr("/dev/full", developed(film, 9)), io::InputError);
}

// What a process that is killed in the middle of a file leaves behind.
TEST(SpectralExr, UntilItIsWholeAFileHasNoName) {
    const TemporaryFolder folder;
    const auto path = folder / "a.exr";
    test::write_bytes(path, {'o', 'l', 'd'});
    const int unnamed = ::open(folder.path().c_str(), O_TMPFILE | O_WRONLY, 0600);
    if (unnamed < 0) GTEST_SKIP() << "this file system has no files without a name";
    ::close(unnamed);
    const Film film = filled(kCrop, 9);
    io::PictureRows rows = developed(film, 9);
    rows.row = [&, inner = rows.row](int y, float* row) {
        EXPECT_EQ(folder.count(), 1u) << y;
        EXPECT_EQ(read_bytes(path).size(), 3u) << y;
        inner(y, row);
        if (y == 34) throw std::runtime_error("enough");  // rows have been written by then
    };
    EXPECT_THROW(io::write_exr(path, rows), std::runtime_error);
    EXPECT_EQ(read_bytes(path), (std::vector<uint8_t>{'o', 'l', 'd'}));
    EXPECT_EQ(folder.count(), 1u);
}

TEST(SpectralLayout, NamesComeBack) {
    EXPECT_EQ(io::spectral_channel(385), "S0.385,0nm");
    EXPECT_EQ(io::spectral_channel(381.25), "S0.381,25nm");
    EXPECT_EQ(io::spectral_channel(380 + 1. / 3), "S0.380,333nm");
    EXPECT_EQ(io::spectral_channel(1000), "S0.1000,0nm");
    for (const double nm : {385., 400.5, 381.25, 729.875, 1000., 0.125})
        EXPECT_EQ(io::spectral_channel_nm(io::spectral_channel(nm)), nm);
}

TEST(SpectralLayout, ReadsWhatTheLayoutAllows) {
    const std::map<std::string, double> good = {
        {"S0.385nm", 385},      {"S0.385,5nm", 385.5},     {"S0.,5um", 500},
        {"S0.5,nm", 5},         {"S0.3,85e-7m", 385},      {"S0.3,85E+2nm", 385},
        {"S0.0,385um", 385},    {"S0.385000pm", 385},      {"S0.0,000385mm", 385},
        {"S0.3,85e-8dam", 385}, {"S0.599,584916THz", 500}, {"S0.5,99584916e14Hz", 500}};
    for (const auto& [name, nm] : good) {
        const auto read = io::spectral_channel_nm(name);
        ASSERT_TRUE(read) << name;
        EXPECT_NEAR(*read, nm, 1e-12 * nm) << name;
    }
    for (const char* name :
         {"S0",         "S0.",        "S0.nm",         "S0.,nm",  "S1.385nm",   "T.385nm",
          "S0.385",     "S0.385.5nm", "S0.-5nm",       "S0.+5nm", "S0.infm",    "S0.nanm",
          "S0.3,8,5nm", "S0.385xm",   "S0.385e nm",    "S0.0nm",  "S0.1e999nm", "S0.385nm ",
          "s0.385nm",   "R",          "S0.385nm.385nm"})
        EXPECT_FALSE(io::spectral_channel_nm(name)) << name;
}

TEST(SpectralLayout, ChannelsGoByWavelength) {
    io::PictureLayout layout;
    layout.channels = {"S0.1000,0nm", "R", "S0.0,4um", "XYZ.X", "S0.385,0nm", "S1.385,0nm"};
    const auto found = io::spectral_channels(layout);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].index, 4u);
    EXPECT_EQ(found[1].index, 2u);
    EXPECT_EQ(found[2].index, 0u);
    EXPECT_DOUBLE_EQ(found[1].nm, 400);
}

TEST(SpectralLayout, APixelsSpectrumIsItsBins) {
    const TemporaryFolder folder;
    io::write_exr(folder / "a.exr", developed(filled(kCrop, 16), 16));
    const io::Picture p = io::read_picture(folder / "a.exr");
    const auto spectrum = io::spectra_of_pixel(p, "a.exr", 6, 38).picture;
    ASSERT_EQ(spectrum.size(), 35u);
    for (size_t i = 0; i < 35; ++i) {
        EXPECT_EQ(spectrum[i][0], 385 + 10 * double(i));
        const Light l = light_of(6, 38);
        EXPECT_FLOAT_EQ(float(spectrum[i][1]), i == 5 ? l.bin_5 : i == 20 ? l.bin_20 : 0.f);
    }
    for (const V2i& at : {V2i(1, 3), V2i(2, 2), V2i(7, 38), V2i(6, 39), V2i(-1, 5)})
        EXPECT_THROW((void)io::spectra_of_pixel(p, "a.exr", at.x, at.y), io::ArgumentError);
}

}  // namespace
}  // namespace petzval::apps
