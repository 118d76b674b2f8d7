// SPDX-License-Identifier: Apache-2.0
// Messages of the library, as the command line spells them.
#pragma once

#include <string>

namespace petzval {

/// Text in which ⟨focus⟩, a field's name in a message, reads --focus, and ⟨sampler⟩, one that
/// compares methods, --method sampler. A value stands behind "=": ⟨focus⟩=1 reads --focus 1.
[[nodiscard]] std::string as_options(const std::string& message);

}  // namespace petzval
