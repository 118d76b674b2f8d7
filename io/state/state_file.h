// SPDX-License-Identifier: Apache-2.0
// State files: the exact sums of a render that is to go on, or to be added to others.
//
// A file is the text "PETZVALS", the version of the format, the length of the header (both 64 bits,
// little-endian), the header as JSON, what Film::pack writes of each pixel in scan order, and the
// FNV-1a hash of all before it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/film/film.h"
#include "io/base/error.h"
#include "io/file/read_file.h"

namespace petzval::io {

/// Part of a frame that a film keeps, and what it keeps of each pixel.
struct FilmShape {
    V2i full_size{0, 0};
    Rect crop;
    std::vector<Aov> layers;
    std::optional<Bins> bins;
    FilmKeeps keeps{};

    bool operator==(const FilmShape&) const = default;
    [[nodiscard]] static FilmShape of(const Film&);
    [[nodiscard]] Film empty_film() const { return {full_size, crop, layers, bins, keeps}; }
    /// Pixels that such a film has.
    [[nodiscard]] Rect pixels() const { return Film::pixels_for(crop, full_size, keeps); }
    /// Memory that such a film takes.
    [[nodiscard]] uint64_t bytes() const;
};

/// Header of a state.
struct StateHeader {
    FilmShape shape;
    SampleRange samples;         ///< that the render is to have of each pixel
    uint64_t pixel_samples = 0;  ///< that are there, of all pixels together
    nlohmann::ordered_json run;  ///< what the program says of the render
    /// Of a render to a noise: nothing is left to render, though pixels have fewer samples.
    bool is_finished = false;

    /// Number of pixel samples that the whole render has.
    [[nodiscard]] uint64_t wanted() const;
    [[nodiscard]] bool is_complete() const { return is_finished || pixel_samples == wanted(); }
};

/// Writes a state: whole, or not at all. pixel_samples is counted, and may not be above what is
/// wanted. Throws OutputError with the system's reason.
void write_state(const std::filesystem::path&, StateHeader, const Film&);

/// A state that is open for reading.
class StateReader {
  public:
    /// Reads the header. Throws InputError where the file is no state, is cut short, or is of
    /// another version of the format.
    explicit StateReader(const std::filesystem::path&);

    [[nodiscard]] const StateHeader& header() const { return header_; }
    /// Reads the file to its end. Throws InputError where the bytes are not those that were
    /// written, or the pixels do not have the samples that the header says.
    void check() const;
    /// Adds the sums to a film that has the state's pixels, with the same layers and bins; some:
    /// only of these pixels. Throws InputError likewise; the film is of no use then.
    void add_to(Film& film) const { add_to(film, header_.shape.pixels()); }
    void add_to(Film&, const Rect& some) const;

  private:
    [[nodiscard]] InputError damaged() const;
    /// Calls use(x, y, packed) for each pixel, and checks all of them.
    template <class Use>
    void read_pixels(const Use&) const;

    std::filesystem::path path_;
    InputFile file_;
    StateHeader header_;
    uint64_t pixels_at_ = 0;  ///< offset in the file
    uint64_t hash_ = 0;       ///< of what is before it
};

}  // namespace petzval::io
