// SPDX-License-Identifier: Apache-2.0
// A film's layers, what it holds, and pixels as bytes.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include "core/film/film.h"
#include "core/film/grown.h"

namespace petzval {
namespace {

constexpr std::array<AovInfo, static_cast<size_t>(Aov::Count)> kAovs{{
    {"albedo", {"albedo.R", "albedo.G", "albedo.B"}, 3},
    {"normal", {"normal.X", "normal.Y", "normal.Z"}, 3},
    {"depth", {"depth.Z", "", ""}, 1},
    {"position", {"position.X", "position.Y", "position.Z"}, 3},
    {"uv", {"uv.U", "uv.V", ""}, 2},
    {"emission", {"emission.R", "emission.G", "emission.B"}, 3},
    {"cost", {"cost.N", "", ""}, 1},
    {"velocity", {"velocity.X", "velocity.Y", ""}, 2},
    {"ghosts", {"ghosts.R", "ghosts.G", "ghosts.B"}, 3},
}};

}  // namespace

const AovInfo& aov_info(Aov aov) {
    return kAovs[static_cast<size_t>(aov)];
}

std::optional<Aov> aov_from_name(std::string_view name) {
    for (size_t i = 0; i < kAovs.size(); ++i)
        if (kAovs[i].name == name) return static_cast<Aov>(i);
    return std::nullopt;
}

Film::Film(V2i full_size, Rect crop, std::vector<Aov> aovs, std::optional<Bins> bins,
           FilmKeeps keeps)
    : full_size_(full_size),
      crop_(crop),
      kept_(pixels_for(crop, full_size, keeps)),
      aovs_(std::move(aovs)),
      pixels_(static_cast<size_t>(kept_.width()) * kept_.height()),
      too_large_(pixels_.size()),
      aov_sums_(pixels_.size() * aovs_.size()) {
    if (bins) spectral_.emplace(pixels_.size(), *bins, keeps.halves);
    if (keeps.blocks) blocks_.emplace(pixels_.size());
    if (keeps.halves) halves_.emplace(pixels_.size());
}

Rect Film::pixels_for(const Rect& crop, V2i full_size, FilmKeeps keeps) {
    if (!keeps.halves) return crop;
    return grown(crop, kDenoiserReach_px, {0, 0, full_size.x, full_size.y});
}

size_t Film::bytes_per_pixel(size_t layers, const std::optional<Bins>& bins, FilmKeeps keeps) {
    return sizeof(Pixel) + sizeof(uint32_t) + layers * sizeof(std::array<FilmSum, 3>) +
           (bins ? SpectralFilm::bytes_per_pixel(*bins, keeps.halves) : 0) +
           (keeps.blocks ? FilmBlocks::bytes_per_pixel() : 0) +
           (keeps.halves ? FilmHalves::bytes_per_pixel() : 0);
}

void Film::pack(int x, int y, uint8_t* to) const {
    const size_t at = offset(x, y), layers = aovs_.size();
    std::memcpy(to, &pixels_[at], sizeof(Pixel));
    to += sizeof(Pixel);
    std::memcpy(to, &too_large_[at], sizeof(uint32_t));
    to += sizeof(uint32_t);
    for (size_t layer = 0; layer < layers; ++layer)
        to = petzval::pack(std::span<const FilmSum>(aov_sums_[at * layers + layer]), to);
    if (spectral_) {
        spectral_->pack(at, to);
        to += SpectralFilm::bytes_per_pixel(spectral_->bins(), halves_.has_value());
    }
    if (blocks_) {
        blocks_->pack(at, to);
        to += FilmBlocks::bytes_per_pixel();
    }
    if (halves_) halves_->pack(at, to);
}

void Film::add_packed(int x, int y, const uint8_t* from) {
    const size_t at = offset(x, y), layers = aovs_.size();
    Pixel other;
    std::memcpy(&other, from, sizeof other);
    from += sizeof other;
    uint32_t too_large;
    std::memcpy(&too_large, from, sizeof too_large);
    from += sizeof too_large;
    too_large_[at] += too_large;
    Pixel& pixel = pixels_[at];
    for (size_t i = 0; i < pixel.sum.size(); ++i) pixel.sum[i] += other.sum[i];
    pixel.count += other.count;
    pixel.hits += other.hits;
    if (other.left_out > 0 && (pixel.left_out == 0 || other.first_left_out < pixel.first_left_out))
        pixel.first_left_out = other.first_left_out;
    pixel.left_out += other.left_out;
    for (size_t layer = 0; layer < layers; ++layer)
        from = petzval::add_packed(std::span<FilmSum>(aov_sums_[at * layers + layer]), from);
    if (spectral_) {
        spectral_->add_packed(at, from);
        from += SpectralFilm::bytes_per_pixel(spectral_->bins(), halves_.has_value());
    }
    if (blocks_) {
        blocks_->add_packed(at, from);
        from += FilmBlocks::bytes_per_pixel();
    }
    if (halves_) halves_->add_packed(at, from);
}

std::optional<uint32_t> Film::packed_count(const uint8_t* from, std::span<const Aov> layers,
                                           const std::optional<Bins>& bins, FilmKeeps keeps,
                                           SampleRange range) {
    Pixel p;
    std::memcpy(&p, from, sizeof p);
    uint32_t too_large;
    std::memcpy(&too_large, from + sizeof p, sizeof too_large);
    const size_t before_layers = sizeof p + sizeof too_large;
    const std::span rest(from + before_layers,
                         bytes_per_pixel(layers.size(), bins, keeps) - before_layers);
    const auto reached = [](const FilmSum& sum, uint32_t count) {
        return std::abs(sum.value()) <= double(count) * double(FilmSum::kLimit);
    };
    bool possible = p.hits <= p.count && uint64_t(p.count) + p.left_out <= range.count() &&
                    too_large <= p.left_out;
    if (p.left_out > 0)
        possible = possible && p.first_left_out >= range.first && p.first_left_out < range.end;
    for (const FilmSum& sum : p.sum) possible = possible && reached(sum, p.count);
    for (size_t i = 0; i < 3 * layers.size(); ++i) {
        FilmSum sum;
        std::memcpy(&sum, rest.data() + i * sizeof sum, sizeof sum);
        possible = possible && reached(sum, layers[i / 3] == Aov::Ghosts ? p.count : p.hits);
    }
    if (p.count == 0)
        possible = possible && std::all_of(rest.begin(), rest.end(), [](auto b) { return b == 0; });
    if (keeps.halves)
        possible =
            possible && FilmHalves::is_possible(
                            rest.data() + rest.size() - FilmHalves::bytes_per_pixel(), p.count);
    return possible ? std::optional(p.count + p.left_out) : std::nullopt;
}

V4f Film::colour(int x, int y) const {
    const Pixel& p = pixel(x, y);
    const double scale = p.count > 0 ? 1.0 / p.count : 0.0;
    const auto mean = [&](int i) { return static_cast<float>(p.sum[size_t(i)].value() * scale); };
    return {mean(0), mean(1), mean(2), mean(3)};
}

V3f Film::aov(int x, int y, size_t layer) const {
    const Pixel& p = pixel(x, y);
    const uint32_t count = aovs_[layer] == Aov::Ghosts ? p.count : p.hits;
    const double scale = count > 0 ? 1.0 / count : 0.0;
    const auto& sum = aov_sums_[offset(x, y) * aovs_.size() + layer];
    const auto mean = [&](int i) { return static_cast<float>(sum[size_t(i)].value() * scale); };
    return {mean(0), mean(1), mean(2)};
}

Film::TakenRange Film::taken_range() const {
    TakenRange range{std::numeric_limits<uint32_t>::max(), 0};
    for (const Pixel& p : pixels_) {
        range.least = std::min(range.least, p.count + p.left_out);
        range.most = std::max(range.most, p.count + p.left_out);
    }
    return range;
}

uint64_t Film::taken_count() const {
    uint64_t total = 0;
    for (const Pixel& p : pixels_) total += p.count + uint64_t(p.left_out);
    return total;
}

Film::LeftOut Film::left_out() const {
    LeftOut all;
    for (int y = crop_.y0; y < crop_.y1; ++y)
        for (int x = crop_.x0; x < crop_.x1; ++x) {
            const Pixel& p = pixel(x, y);
            if (all.count() == 0 && p.left_out > 0) all = {0, 0, x, y, p.first_left_out};
            all.too_large += too_large_[offset(x, y)];
            all.not_finite += p.left_out - too_large_[offset(x, y)];
        }
    return all;
}

}  // namespace petzval
