// SPDX-License-Identifier: Apache-2.0
// Rows of the table of fields, by what they are of.
#pragma once

#include <vector>

#include "apps/request/fields.h"

namespace petzval::apps {

/// Fields of one group, taken by these commands.
[[nodiscard]] std::vector<RequestField> in_group(const std::string& group, uint8_t takers,
                                                 std::vector<RequestField> fields,
                                                 FieldPart part = FieldPart::Picture);

[[nodiscard]] std::vector<RequestField> frame_fields();   ///< scene, size, samples
[[nodiscard]] std::vector<RequestField> path_fields();    ///< paths, light, spectrum
[[nodiscard]] std::vector<RequestField> camera_fields();  ///< camera, lens, exposure
[[nodiscard]] std::vector<RequestField> run_fields();     ///< files, sequences, how it runs

}  // namespace petzval::apps
