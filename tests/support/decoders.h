// SPDX-License-Identifier: Apache-2.0
// The readers of files that strangers make, each by a word: what the fuzzer feeds, and what replays
// its corpus.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/aperture/aperture_file.h"
#include "io/base/error.h"
#include "io/glass/agf.h"
#include "io/gltf/gltf.h"
#include "io/ies/ies.h"
#include "io/image/environment.h"
#include "io/image/picture_files.h"
#include "io/lens/lens_file.h"
#include "io/spectra/spectra.h"
#include "tests/support/meshes/decoders.h"

namespace petzval::test {

/// A reader, and the ending that a file must have for it.
struct Decoder {
    std::string ending;
    std::function<void(const std::filesystem::path&)> read;
};

/// Every reader, by the name of its folder in tests/data/corpus.
[[nodiscard]] inline const std::map<std::string, Decoder>& decoders() {
    namespace fs = std::filesystem;
    const auto bytes_of = [](const fs::path& path) {
        std::ifstream in(path, std::ios::binary);
        return std::vector<uint8_t>(std::istreambuf_iterator<char>(in), {});
    };
    const auto codec = [bytes_of](bool (*decodes)(std::span<const uint8_t>)) -> Decoder {
        return {".bin", [bytes_of, decodes](const fs::path& path) {
                    if (!decodes(bytes_of(path)))
                        throw io::InputError(path.string(), "", "is broken");
                }};
    };
    const auto lens = [](const fs::path& path) { (void)io::load_lens(path.string()); };
    const auto picture = [](const fs::path& path) { (void)io::read_picture(path); };
    const auto load_with_more = [](const fs::path& path) {
        io::PictureBudget pictures;
        (void)io::load_gltf(path, io::FileScope::Anywhere, pictures,
                            {.scene = {},
                             .variant = {},
                             .point_line_radius_m = 0.1f,
                             .animation = io::AnimationChoice{0.5, {}, true}});
    };
    const auto load_still_and_open = [](const fs::path& path) {
        (void)io::load_gltf(path);
        io::PictureBudget pictures;
        io::GltfChoices open;
        open.animation = io::AnimationChoice{1, {}, true, 1};
        (void)io::load_gltf(path, io::FileScope::Anywhere, pictures, open);
    };
    static const std::map<std::string, Decoder> all = {
        {"gltf", {".gltf", load_with_more}},
        {"glb", {".glb", load_still_and_open}},
        {"draco", codec(decodes_draco)},
        {"meshopt", codec(decodes_meshopt)},
        {"texture",
         {".bin",
          [bytes_of](const fs::path& path) {
              io::PictureBudget budget;
              (void)io::decode_image(bytes_of(path), path.string(), "/images/0", budget);
          }}},
        {"exr", {".exr", picture}},
        {"hdr",
         {".hdr",
          [](const fs::path& path) {
              io::PictureBudget budget;
              (void)io::load_sky(
                  path, 0, 1, [](auto&) {}, budget);
          }}},
        {"png",
         {".png",
          [](const fs::path& path) { (void)io::read_mask_aperture(path, io::PictureBudget()); }}},
        {"jpg", {".jpg", picture}},
        {"svg", {".svg", [](const fs::path& path) { (void)io::read_svg_aperture(path); }}},
        {"lens_json", {".json", lens}},
        {"lens_dat", {".dat", lens}},
        {"lens_zmx", {".zmx", lens}},
        {"agf",
         {".agf",
          [](const fs::path& path) {
              const io::AgfCatalog catalog(path);
              for (const char* name : {"A", "B", "C", "D", "N-BK7"}) (void)catalog.find(name);
          }}},
        {"ies",
         {".ies",
          [bytes_of](const fs::path& path) {
              const std::vector<uint8_t> bytes = bytes_of(path);
              const io::IesFile found =
                  io::parse_ies({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                                path.string(), "/extensions/EXT_lights_ies/lights/0");
              for (const V3f& d : {V3f(0, 0, 1), V3f(-1, 0, 0), petzval::unit(V3f(1, -2, 0.5f))})
                  if (!(found.profile.intensity(d) >= 0)) std::abort();
              if (!(found.profile.flux_lm() >= 0)) std::abort();
          }}},
        {"spectrum",
         {".csv", [](const fs::path& path) { (void)io::find_illuminant(path.string()); }}},
        {"response",
         {".csv", [](const fs::path& path) { (void)io::find_response(path.string()); }}},
    };
    return all;
}

/// Whether the bytes, as a file in that folder, are accepted. Lets any exception but InputError
/// escape.
inline bool is_accepted(const Decoder& decoder, std::span<const uint8_t> bytes,
                        const std::filesystem::path& folder) {
    const auto path = folder / ("file" + decoder.ending);
    {
        std::ofstream out(path, std::ios::binary);
        out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    }
    try {
        decoder.read(path);
        return true;
    } catch (const io::InputError&) {
        return false;
    }
}

}  // namespace petzval::test
