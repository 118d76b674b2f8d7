// SPDX-License-Identifier: Apache-2.0
// A lens on the bench, for a page: its section with rays, and its figures at a point of the field.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace petzval {

struct BenchRequest {
    std::string lens;      ///< name of one that ships
    std::string edited;    ///< text of a lens file in our JSON, in place of it; or empty
    double height_mm = 0;  ///< of the field point on the film, from its middle
    double focus_m = 0;    ///< from the entrance pupil; 0: a distant object
    double fstop = 0;      ///< 0: wide open
};

/// Text of the file of a lens that ships. Throws ArgumentError for another name.
[[nodiscard]] std::string lens_text(const std::string& name);

/// {"elements", "faces", "stop", "film": the section, mm; "rays": of F, d, C; "spots": um from
/// their middle; "fans", "mtf"; "figures": [name, text]}. Throws InputError where the lens is not
/// as it must be or passes no light there.
[[nodiscard]] nlohmann::json bench_facts(const BenchRequest&);

}  // namespace petzval
