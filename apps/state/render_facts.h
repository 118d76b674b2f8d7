// SPDX-License-Identifier: Apache-2.0
// Facts of a render: everything that its samples follow from, so that two renders can be compared.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/setup/render_setup.h"
#include "integrator/path/path_options.h"
#include "integrator/render/render_job.h"
#include "io/file/overwrite.h"
#include "io/image/output.h"
#include "io/picture/picture.h"
#include "io/state/state_file.h"

namespace petzval::apps {

/// Facts of a render, name by name. Two renders with the same facts have the same samples.
struct RenderFacts {
    using Texts = std::vector<std::pair<std::string, std::string>>;

    io::Metadata metadata;  ///< of pictures
    Texts inputs;   ///< hashes of files that are not in the metadata, and of what pilots learned
    Texts display;  ///< how PNG and JPEG show the picture
    std::shared_ptr<const integrator::NoiseTarget> noise;  ///< that is to be reached; empty: none
};

/// Facts of how PNG and JPEG show a picture, with a hash of the files that its configuration reads.
[[nodiscard]] RenderFacts::Texts display_facts(const io::DisplayOptions&);

/// Facts of a render that is set up.
[[nodiscard]] RenderFacts facts_of(const RenderSetup&, const integrator::RenderJob&,
                                   const integrator::PathOptions&, const io::DisplayOptions&);

/// Facts as JSON, and back. Throws a nlohmann::json exception where something is missing.
[[nodiscard]] nlohmann::ordered_json to_json(const RenderFacts&);
[[nodiscard]] RenderFacts facts_from(const nlohmann::ordered_json&);

/// A render to compare: its facts, its film, and what it is called.
struct ComparedRender {
    const RenderFacts& facts;
    const io::FilmShape& shape;
    std::string name;
};

enum class Compare : uint8_t { Samples, Pictures };

/// The first difference between two renders, as "the seed is 1 in A and 2 in B"; nothing where
/// samples of one are samples of the other and, if that is compared, they are shown alike. Crops
/// and ranges of samples may differ.
[[nodiscard]] std::optional<std::string> difference(const ComparedRender& a,
                                                    const ComparedRender& b, Compare);

/// Names of the hashes in a picture's metadata.
inline constexpr const char* kLightHash = "petzval:lightHash";
inline constexpr const char* kDisplayHash = "petzval:displayHash";

/// Hashes as 16 digits: of the light, that is of all facts but the display's, the shape and the
/// samples; and of the display's facts.
[[nodiscard]] std::string light_hash(const RenderFacts&, const io::FilmShape&, SampleRange);
[[nodiscard]] std::string display_hash(const RenderFacts::Texts& display);

}  // namespace petzval::apps
