// SPDX-License-Identifier: Apache-2.0
#include "io/state/state_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <cstring>
#include <limits>
#include <span>

#include "io/base/error.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/statistics.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

const FilmShape kShape{{20, 10}, {3, 2, 17, 9}, {Aov::Depth, Aov::Normal}, Bins{380, 50, 7}};
constexpr SampleRange kSamples{16, 40};

/// A film of any numbers; pixels have up to `most` samples, one of them fewer where it is not
/// whole.
Film filled(bool whole) {
    Film film = kShape.empty_film();
    test::Random random(1);
    for (int y = kShape.crop.y0; y < kShape.crop.y1; ++y)
        for (int x = kShape.crop.x0; x < kShape.crop.x1; ++x)
            for (uint32_t i = kSamples.first; i < kSamples.end - (whole ? 0 : x % 3); ++i) {
                FilmSample sample;
                sample.colour = Rgb(random.next(), 1e6f * random.next(), -random.next());
                if (random.next() < 0.02f)
                    sample.colour = Rgb(std::numeric_limits<float>::quiet_NaN());
                sample.alpha = random.next();
                sample.hit = random.next() < 0.5f;
                for (V3f& layer : sample.aov) layer = V3f(random.next());
                Bands bands = Bands::rgb();
                bands.nm = f4{400, 500, 600, 0};
                film.add(x, y, i, sample, {i % kReplicates, splat(random.next()), V3f(1, 2, 3)},
                         bands);
            }
    return film;
}

std::vector<uint8_t> bytes_of(const Film& film) {
    const size_t each = Film::bytes_per_pixel(kShape.layers.size(), kShape.bins);
    std::vector<uint8_t> out;
    for (int y = kShape.crop.y0; y < kShape.crop.y1; ++y)
        for (int x = kShape.crop.x0; x < kShape.crop.x1; ++x) {
            out.resize(out.size() + each);
            film.pack(x, y, out.data() + out.size() - each);
        }
    return out;
}

class StateFile : public ::testing::Test {
  protected:
    test::TemporaryFolder folder_;
    std::filesystem::path path_ = folder_ / "a.state";
    const StateHeader header_{kShape, kSamples, 0, {{"name", "München"}, {"n", 3.5}}};

    [[nodiscard]] std::vector<uint8_t> bytes() const {
        std::ifstream in(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void write(const std::vector<uint8_t>& bytes) const {
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    }
    /// What reading all of it says; empty where it succeeds.
    [[nodiscard]] std::string complaint() const {
        try {
            StateReader reader(path_);
            Film film = reader.header().shape.empty_film();
            reader.add_to(film);
            return "";
        } catch (const InputError& error) {
            return error.what();
        }
    }
};

TEST_F(StateFile, HoldsAFilmToTheBit) {
    for (const bool whole : {false, true}) {
        const Film film = filled(whole);
        ASSERT_GT(film.left_out().count(), 0u);
        write_state(path_, header_, film);
        StateReader reader(path_);
        const StateHeader& read = reader.header();
        EXPECT_EQ(read.shape.full_size, kShape.full_size);
        EXPECT_EQ(read.shape.crop, kShape.crop);
        EXPECT_EQ(read.shape.layers, kShape.layers);
        EXPECT_EQ(read.shape.bins, kShape.bins);
        EXPECT_EQ(read.samples, kSamples);
        EXPECT_EQ(read.run, header_.run);
        EXPECT_EQ(read.is_complete(), whole);
        Film again = read.shape.empty_film();
        reader.add_to(again);
        EXPECT_EQ(bytes_of(again), bytes_of(film));
    }
}

// Whatever bit flips, a whole byte at a time in each place: no film comes out of it.
TEST_F(StateFile, EveryFlippedByteIsFound) {
    write_state(path_, header_, filled(true));
    const std::vector<uint8_t> good = bytes();
    EXPECT_EQ(complaint(), "");
    const size_t header_bytes = 600;
    ASSERT_GT(good.size(), 4 * header_bytes);
    for (size_t i = 0; i < good.size(); i += i < header_bytes ? 1 : 211)
        for (const uint8_t flip : {0x01, 0x80}) {
            std::vector<uint8_t> bad = good;
            bad[i] ^= flip;
            write(bad);
            EXPECT_NE(complaint(), "") << i << ' ' << int(flip);
        }
    write({good.begin(), good.end()});
    EXPECT_EQ(complaint(), "");
}

TEST_F(StateFile, EveryLengthButTheRightOneIsRefused) {
    write_state(path_, header_, filled(true));
    std::vector<uint8_t> cut = bytes();
    cut.push_back(0);
    write(cut);
    EXPECT_NE(complaint().find("cut short"), std::string::npos) << complaint();
    cut.pop_back();
    while (!cut.empty()) {
        cut.resize(cut.size() > 300 ? cut.size() * 3 / 4 : cut.size() - 1);
        write(cut);
        const std::string found = complaint();
        EXPECT_TRUE(found.find("cut short") != found.npos ||
                    found.find("no state of a render") != found.npos ||
                    (cut.empty() && found.ends_with("is empty")))
            << cut.size() << found;
    }
}

TEST_F(StateFile, AnotherVersionSaysWhichOne) {
    write_state(path_, header_, filled(true));
    std::vector<uint8_t> other = bytes();
    other[8] = 7;
    write(other);
    EXPECT_EQ(complaint(), path_.string() +
                               ": is a state of version 7, and this program reads version 5; use "
                               "the program that wrote it");
}

TEST_F(StateFile, WhatIsNoStateIsRefused) {
    EXPECT_EQ(complaint(), path_.string() + ": no such file");
    std::filesystem::create_directory(path_);
    EXPECT_EQ(complaint(), path_.string() + ": is a folder");
    std::filesystem::remove(path_);
    mkfifo(path_.c_str(), 0600);  // which nobody writes to: it must not wait
    EXPECT_EQ(complaint(), path_.string() + ": is not a regular file");
    std::filesystem::remove(path_);
    write({'P', 'N', 'G'});
    EXPECT_EQ(complaint(), path_.string() + ": is a text file, and no state of a render");
    write({0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'});
    EXPECT_EQ(complaint(), path_.string() + ": is no state of a render");
    write(std::vector<uint8_t>(64, 0));
    EXPECT_EQ(complaint(), path_.string() + ": is no state of a render");
    write({});
    EXPECT_EQ(complaint(), path_.string() + ": is empty");
}

// A header that asks for a film beyond all memory, or for nonsense, is that of a damaged file.
TEST_F(StateFile, ImpossibleHeadersAreRefused) {
    write_state(path_, header_, filled(true));
    const std::vector<uint8_t> good = bytes();
    const std::vector<std::array<std::string, 2>> changes = {
        {R"("size_px":[20,10])", R"("size_px":[2 ,10])"},
        {R"("size_px":[20,10])", R"("size_px":[2e9,9])"},
        {R"("size_px":[20,10])", R"("size_px":[20, 8])"},
        {R"("crop_px":[3,2,17,9])", R"("crop_px":[3,2,3 ,9])"},
        {R"("crop_px":[3,2,17,9])", R"("crop_px":[-7,2,7,9])"},
        {R"("samples":[16,40])", R"("samples":[40,40])"},
        {R"(,50.0,7])", R"(,50.0,0])"},
        {R"(,50.0,7])", R"(, 0.0,7])"},
        {R"(,50.0,7])", R"(,5.0,9e9)"},
        {R"("depth","normal")", R"("depth","normel")"},
        {R"("depth","normal")", R"("depth"         )"},
        {R"("pixel_samples":2352)", R"("pixel_samples":2353)"},
        {R"("pixel_samples":)", R"("pixel_xamples":)"}};
    for (const auto& [before, after] : changes) {
        ASSERT_EQ(before.size(), after.size());
        std::string text(good.begin(), good.end());
        const size_t at = text.find(before);
        ASSERT_NE(at, std::string::npos) << before;
        text.replace(at, before.size(), after);
        write({text.begin(), text.end()});
        // Before any pixel is read, and not by the checksum.
        EXPECT_EQ(complaint(), path_.string() + ": is damaged or cut short") << after;
    }
    FilmShape no_bins = kShape;  // as long as it says
    no_bins.bins->count = 0;
    write_state(path_, {no_bins, kSamples, 0, {}}, no_bins.empty_film());
    EXPECT_EQ(complaint(), path_.string() + ": is damaged or cut short");
    write_state(path_, {kShape, {40, 40}, 0, {}}, kShape.empty_film());
    EXPECT_EQ(complaint(), path_.string() + ": is damaged or cut short");
}

// A header that is nested so deeply that copies of it would fill the stack.
TEST_F(StateFile, DeepHeadersAreRefused) {
    nlohmann::ordered_json deep = 1;
    for (int i = 0; i < 100; ++i) deep = {deep};
    write_state(path_, {kShape, kSamples, 0, deep}, filled(true));
    EXPECT_NE(complaint().find("is damaged"), std::string::npos) << complaint();
}

TEST_F(StateFile, CheckReadsAllOfIt) {
    write_state(path_, header_, filled(true));
    std::vector<uint8_t> bad = bytes();
    EXPECT_NO_THROW(StateReader(path_).check());
    bad[bad.size() - 20] ^= 4;
    write(bad);
    EXPECT_THROW(StateReader(path_).check(), InputError);
}

// Counts and sums that no render has, with the checksum that belongs to them.
TEST_F(StateFile, ForgedCountsAndSumsAreFound) {
    write_state(path_, header_, filled(true));
    const std::vector<uint8_t> good = bytes();
    const size_t each = Film::bytes_per_pixel(kShape.layers.size(), kShape.bins),
                 pixels = size_t(kShape.crop.width()) * size_t(kShape.crop.height()),
                 first = good.size() - 8 - each * pixels;
    // Behind four sums; the sums of layers come last.
    constexpr size_t kCount = 64, kHits = 68, kBad = 72, kFirstBad = 76, kTooLarge = 80;
    using Unaligned [[gnu::aligned(1)]] = uint32_t;
    const auto forged = [&](const auto& edit) {
        std::vector<uint8_t> bad = good;
        const auto at = [&](size_t pixel, size_t offset) -> Unaligned& {
            return *reinterpret_cast<Unaligned*>(&bad[first + pixel * each + offset]);
        };
        edit(at);
        const uint64_t hash = fnv1a(std::span(bad).first(bad.size() - 8));
        std::memcpy(&bad[bad.size() - 8], &hash, 8);
        write(bad);
        EXPECT_THROW(StateReader(path_).check(), InputError);
        return complaint();
    };
    const auto refused = [&](const auto& edit) {
        return forged(edit).find("is damaged") != std::string::npos;
    };
    EXPECT_TRUE(refused([](auto at) { at(0, kCount) -= 1; }));
    EXPECT_TRUE(refused([](auto at) { at(0, kCount) += 1, at(1, kCount) -= 1; })) << "same total";
    EXPECT_TRUE(refused([](auto at) { at(0, kBad) += 0u - at(0, kCount), at(0, kCount) *= 2; }));
    EXPECT_TRUE(refused([](auto at) { at(2, kTooLarge) = at(2, kBad) + 1; }));
    EXPECT_TRUE(refused([](auto at) { at(3, kHits) = at(3, kCount) + 1; }));
    EXPECT_TRUE(
        refused([](auto at) { at(0, kBad) = 1, at(0, kCount) -= 1, at(0, kFirstBad) = 40; }));
    EXPECT_TRUE(refused([](auto at) { at(5, 12) = 0x40000000; })) << "of red";
    EXPECT_TRUE(refused([](auto at) { at(5, kTooLarge + 4 + 12) = 0x40000000; })) << "of a layer";
    EXPECT_TRUE(refused([](auto at) {
        at(7, kBad) += at(7, kCount), at(7, kFirstBad) = 16, at(7, kCount) = at(7, kHits) = 0;
    })) << "light without samples";
    write(good);
    EXPECT_EQ(complaint(), "");
}

// A disk that fills up: the state before is still there, whole.
TEST_F(StateFile, IsWholeOrWhatItWas) {
    write_state(path_, header_, filled(false));
    const std::vector<uint8_t> before = bytes();
    {
        const test::FileSizeLimit limit(before.size() / 2);
        EXPECT_THROW(write_state(path_, header_, filled(true)), OutputError);
    }
    EXPECT_EQ(bytes(), before);
    EXPECT_EQ(folder_.count(), 1u);
}

}  // namespace
}  // namespace petzval::io
