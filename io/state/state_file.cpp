// SPDX-License-Identifier: Apache-2.0
#include "io/state/state_file.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string_view>

#include "io/file/atomic_file.h"

namespace petzval::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kMagic = "PETZVALS";
/// What a pixel holds, and how many pixels a film keeps about its crop, are parts of the format.
constexpr uint64_t kVersion = 5;
/// Bytes before the header: the text, the version and the length.
constexpr size_t kStartBytes = kMagic.size() + 2 * sizeof(uint64_t);
/// Longest header: a command line and the facts of a scene are far shorter.
constexpr uint64_t kMostHeaderBytes = uint64_t(1) << 26;

std::span<const uint8_t> bytes_of(std::string_view text) {
    return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

std::span<const uint8_t> bytes_of(const uint64_t& number) {
    return {reinterpret_cast<const uint8_t*>(&number), sizeof number};
}

size_t pixel_bytes(const FilmShape& shape) {
    return Film::bytes_per_pixel(shape.layers.size(), shape.bins, shape.keeps);
}

Json to_json(const StateHeader& h) {
    const Rect& c = h.shape.crop;
    Json layers = Json::array(), bins = nullptr;
    for (const Aov layer : h.shape.layers) layers.push_back(aov_info(layer).name);
    if (const auto& b = h.shape.bins) bins = {b->first_edge_nm, b->width_nm, b->count};
    return {{"size_px", {h.shape.full_size.x, h.shape.full_size.y}},
            {"crop_px", {c.x0, c.y0, c.x1, c.y1}},
            {"layers", std::move(layers)},
            {"bins_nm", std::move(bins)},
            {"noise_blocks", h.shape.keeps.blocks},
            {"halves", h.shape.keeps.halves},
            {"finished", h.is_finished},
            {"samples", {h.samples.first, h.samples.end}},
            {"pixel_samples", h.pixel_samples},
            {"run", h.run}};
}

// Throws a nlohmann::json exception where a member is missing or of another type.
StateHeader from_json(const Json& json) {
    StateHeader h;
    FilmShape& shape = h.shape;
    json.at("size_px").at(0).get_to(shape.full_size.x);
    json.at("size_px").at(1).get_to(shape.full_size.y);
    const auto crop = json.at("crop_px").get<std::array<int, 4>>();
    shape.crop = {crop[0], crop[1], crop[2], crop[3]};
    for (const auto& name : json.at("layers"))
        shape.layers.push_back(aov_from_name(name.get<std::string>()).value());
    if (const Json& b = json.at("bins_nm"); !b.is_null())
        shape.bins = Bins{b.at(0).get<double>(), b.at(1).get<double>(), b.at(2).get<int>()};
    const auto samples = json.at("samples").get<std::array<uint32_t, 2>>();
    h.samples = {samples[0], samples[1]};
    json.at("pixel_samples").get_to(h.pixel_samples);
    json.at("noise_blocks").get_to(shape.keeps.blocks);
    json.at("halves").get_to(shape.keeps.halves);
    json.at("finished").get_to(h.is_finished);
    h.run = json.at("run");
    return h;
}

bool is_possible(const StateHeader& h) {
    constexpr int kMostBins = 1 << 12, kLargestSide_px = 1 << 20;
    const FilmShape& s = h.shape;
    const Rect& c = s.crop;
    return s.full_size.x <= kLargestSide_px && s.full_size.y <= kLargestSide_px && c.x0 >= 0 &&
           c.y0 >= 0 && c.x0 < c.x1 && c.y0 < c.y1 && c.x1 <= s.full_size.x &&
           c.y1 <= s.full_size.y && h.samples.first < h.samples.end &&
           h.pixel_samples <= h.wanted() && s.layers.size() <= static_cast<size_t>(Aov::Count) &&
           (!s.bins || (s.bins->count > 0 && s.bins->count <= kMostBins && s.bins->width_nm > 0));
}

uint64_t area_of(const Rect& rect) {
    return static_cast<uint64_t>(rect.width()) * static_cast<uint64_t>(rect.height());
}

}  // namespace

FilmShape FilmShape::of(const Film& film) {
    FilmShape shape{film.full_size(), film.crop(), film.aovs(), {}, film.keeps()};
    if (film.spectral()) shape.bins = film.spectral()->bins();
    return shape;
}

uint64_t FilmShape::bytes() const {
    return area_of(pixels()) * pixel_bytes(*this);
}

uint64_t StateHeader::wanted() const {
    return area_of(shape.pixels()) * samples.count();
}

void write_state(const std::filesystem::path& path, StateHeader header, const Film& film) {
    const Rect pixels = header.shape.pixels();
    header.pixel_samples = film.taken_count();
    if (header.pixel_samples > header.wanted())
        throw std::logic_error("a film has more samples than its state may have");
    const std::string text = to_json(header).dump();
    AtomicFile file(path);
    uint64_t offset = 0, hash = fnv1a({});
    const auto put = [&](std::span<const uint8_t> bytes) {
        file.write(bytes, offset);
        offset += bytes.size();
        hash = fnv1a(bytes, hash);
    };
    put(bytes_of(kMagic));
    put(bytes_of(kVersion));
    put(bytes_of(text.size()));
    put(bytes_of(text));
    const size_t each = pixel_bytes(header.shape);
    std::vector<uint8_t> row(static_cast<size_t>(pixels.width()) * each);
    for (int y = pixels.y0; y < pixels.y1; ++y) {
        for (int x = pixels.x0; x < pixels.x1; ++x)
            film.pack(x, y, row.data() + static_cast<size_t>(x - pixels.x0) * each);
        put(row);
    }
    file.write(bytes_of(hash), offset);
    file.commit();
}

StateReader::StateReader(const std::filesystem::path& path) : path_(path), file_(path) {
    const auto refuse = [&](const std::string& why) { return InputError(path.string(), "", why); };
    if (!file_.error().empty()) throw refuse(file_.error());
    std::array<uint8_t, kStartBytes> start{};
    const size_t there = file_.read(start, 0);
    if (there != start.size() || std::memcmp(start.data(), kMagic.data(), kMagic.size()) != 0)
        throw refuse(is_text({reinterpret_cast<const char*>(start.data()), there})
                         ? "is a text file, and no state of a render"
                         : "is no state of a render");
    uint64_t version = 0, length = 0;
    std::memcpy(&version, start.data() + 8, 8);
    std::memcpy(&length, start.data() + 16, 8);
    if (version != kVersion)
        throw refuse(
            fmt::format("is a state of version {}, and this program reads version {}; use the "
                        "program that wrote it",
                        version, kVersion));
    const InputError cut_short = refuse("is damaged or cut short");
    if (length > kMostHeaderBytes || length + start.size() > file_.size()) throw cut_short;
    std::vector<uint8_t> text(length);
    if (file_.read(text, start.size()) != length) throw cut_short;
    try {
        header_ = from_json(Json::parse(text, [](int depth, Json::parse_event_t, Json&) {
            // Copies of what is nested deeply would fill the stack.
            constexpr int kDeepest = 16;
            if (depth > kDeepest) throw std::length_error("nested too deeply");
            return true;
        }));
    } catch (const std::exception&) {  // of JSON, or of a layer that has no such name
        throw cut_short;
    }
    if (!is_possible(header_) ||
        file_.size() != start.size() + length + header_.shape.bytes() + sizeof(uint64_t))
        throw cut_short;
    pixels_at_ = start.size() + length;
    hash_ = fnv1a(text, fnv1a(start));
}

InputError StateReader::damaged() const {
    return {path_.string(), "", "is damaged: its bytes are not those that were written"};
}

template <class Use>
void StateReader::read_pixels(const Use& use) const {
    const FilmShape& shape = header_.shape;
    const size_t each = pixel_bytes(shape);
    const Rect pixels = shape.pixels();
    std::vector<uint8_t> row(static_cast<size_t>(pixels.width()) * each);
    uint64_t taken = 0, hash = hash_, at = pixels_at_, written = 0;
    for (int y = pixels.y0; y < pixels.y1; ++y, at += row.size()) {
        if (file_.read(row, at) != row.size()) throw damaged();
        hash = fnv1a(row, hash);
        for (int x = pixels.x0; x < pixels.x1; ++x) {
            const uint8_t* const pixel = row.data() + static_cast<size_t>(x - pixels.x0) * each;
            const auto count =
                Film::packed_count(pixel, shape.layers, shape.bins, shape.keeps, header_.samples);
            if (!count) throw damaged();
            taken += *count;
            use(x, y, pixel);
        }
    }
    std::array<uint8_t, sizeof written> end{};
    const bool ends = file_.read(end, at) == end.size();
    std::memcpy(&written, end.data(), end.size());
    if (!ends || written != hash || taken != header_.pixel_samples) throw damaged();
}

void StateReader::check() const {
    read_pixels([](int, int, const uint8_t*) {});
}

void StateReader::add_to(Film& film, const Rect& some) const {
    read_pixels([&](int x, int y, const uint8_t* pixel) {
        if (x >= some.x0 && x < some.x1 && y >= some.y0 && y < some.y1)
            film.add_packed(x, y, pixel);
    });
}

}  // namespace petzval::io
