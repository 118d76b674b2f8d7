// SPDX-License-Identifier: Apache-2.0
// Messages of the library, as those who show them spell the names of fields.
#pragma once

#include <functional>
#include <string>

namespace petzval::apps {

/// Spelling of a field's name; has_value: a value follows, and the spelling ends with what stands
/// between them.
using NameSpelling = std::function<std::string(const std::string& name, bool has_value)>;

/// Text in which each name of a field that stands as ⟨focus⟩, with the "=" before a value, is
/// spelled so.
[[nodiscard]] std::string with_names(const std::string& message, const NameSpelling&);

/// Text in which ⟨focus⟩, a field's name in a message, reads --focus, and ⟨sampler⟩, one that
/// compares methods, --method sampler. A value stands behind "=": ⟨focus⟩=1 reads --focus 1.
[[nodiscard]] std::string as_options(const std::string& message);

}  // namespace petzval::apps
