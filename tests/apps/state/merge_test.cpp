// SPDX-License-Identifier: Apache-2.0
#include "apps/state/merge.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "io/base/error.h"

namespace petzval::apps {
namespace {

std::vector<std::filesystem::path> names(size_t count) {
    std::vector<std::filesystem::path> out;
    for (size_t i = 0; i < count; ++i) out.emplace_back(fmt::format("{}.state", i));
    return out;
}

std::string complaint(const std::vector<StateBox>& parts) {
    try {
        static_cast<void>(covered_box(parts, names(parts.size())));
        return "";
    } catch (const io::InputError& error) {
        return error.what();
    }
}

// A box that is cut at random places, again and again.
std::vector<StateBox> cut_up(StateBox whole, int cuts, std::mt19937& random) {
    std::vector<StateBox> parts{whole};
    for (int i = 0; i < cuts; ++i) {
        const size_t at = random() % parts.size();
        StateBox a = parts[at], b = a;
        switch (random() % 3) {
            case 0:
                if (a.crop.width() < 2) continue;
                a.crop.x1 = b.crop.x0 =
                    a.crop.x0 + 1 + int(random() % unsigned(a.crop.width() - 1));
                break;
            case 1:
                if (a.crop.height() < 2) continue;
                a.crop.y1 = b.crop.y0 =
                    a.crop.y0 + 1 + int(random() % unsigned(a.crop.height() - 1));
                break;
            default:
                if (a.samples.count() < 2) continue;
                a.samples.end = b.samples.first =
                    a.samples.first + 1 + random() % (a.samples.count() - 1);
        }
        parts[at] = a;
        parts.push_back(b);
    }
    return parts;
}

TEST(CoveredBox, OfPartsThatFillABox) {
    std::mt19937 random(1);
    const StateBox whole{{10, 20, 50, 40}, {64, 1024}};
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<StateBox> parts = cut_up(whole, int(random() % 30), random);
        std::shuffle(parts.begin(), parts.end(), random);
        const StateBox found = covered_box(parts, names(parts.size()));
        EXPECT_EQ(found.crop, whole.crop);
        EXPECT_EQ(found.samples, whole.samples);
    }
}

// Whether the box that the message names is one of the part that was taken away.
bool names_a_hole(const std::string& message, const StateBox& part) {
    unsigned first = 0, end = 0;
    int x = 0, y = 0, w = 0, h = 0;
    const size_t at = message.find("samples ");
    if (at == message.npos ||
        sscanf(message.c_str() + at, "samples %u:%u of the pixels %d,%d,%d,%d", &first, &end, &x,
               &y, &w, &h) != 6)
        return false;
    return x >= part.crop.x0 && x + w <= part.crop.x1 && y >= part.crop.y0 &&
           y + h <= part.crop.y1 && first >= part.samples.first && end <= part.samples.end &&
           w > 0 && h > 0 && first < end;
}

TEST(CoveredBox, NamesWhatIsMissing) {
    std::mt19937 random(2);
    const StateBox whole{{0, 0, 30, 20}, {0, 256}};
    int inner = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<StateBox> parts = cut_up(whole, 20, random);
        const size_t at = random() % parts.size();
        const StateBox lost = parts[at];
        parts.erase(parts.begin() + std::ptrdiff_t(at));
        const std::string found = complaint(parts);
        if (found.empty()) continue;  // a whole side of the box: what is left is a smaller box
        ++inner;
        EXPECT_TRUE(names_a_hole(found, lost)) << found;
    }
    EXPECT_GT(inner, 200);
}

TEST(CoveredBox, NamesThoseThatOverlap) {
    std::mt19937 random(3);
    const StateBox whole{{0, 0, 30, 20}, {0, 256}};
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<StateBox> parts = cut_up(whole, 20, random);
        const size_t at = random() % parts.size();
        parts.push_back(parts[at]);
        const std::string found = complaint(parts);
        EXPECT_NE(found.find(fmt::format("{}.state", at)), std::string::npos) << found;
        EXPECT_NE(found.find(fmt::format("{}.state", parts.size() - 1)), std::string::npos)
            << found;
    }
}

TEST(CoveredBox, SaysHowTheGapIsFilled) {
    const Rect frame{0, 0, 8, 4};
    EXPECT_EQ(
        complaint({{frame, {0, 16}}, {frame, {32, 64}}, {frame, {64, 65}}}),
        "0.state: this state and the others leave a gap: samples 16:32 of the pixels 0,0,8,4 are "
        "in none of them; render them by ⟨spp⟩ 16:32 and, for a part of the frame, "
        "⟨crop⟩");
    EXPECT_EQ(
        complaint({{frame, {0, 16}}, {frame, {15, 64}}}),
        "0.state: has samples that are in 1.state too: samples 0:16 of the pixels 0,0,8,4 and "
        "samples 15:64 of the pixels 0,0,8,4; a sample counts once");
}

// As many as a farm makes.
TEST(CoveredBox, OfTenThousandParts) {
    std::vector<StateBox> parts;
    for (uint32_t i = 0; i < 10'000; ++i) parts.push_back({{0, 0, 8, 4}, {16 * i, 16 * i + 16}});
    EXPECT_EQ(complaint(parts), "");
    parts.erase(parts.begin() + 5000);
    EXPECT_NE(complaint(parts).find("samples 80000:80016"), std::string::npos);
}

}  // namespace
}  // namespace petzval::apps
