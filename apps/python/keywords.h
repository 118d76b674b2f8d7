// SPDX-License-Identifier: Apache-2.0
// Fields of a request as Python spells them: keywords of functions.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "apps/request/render_order.h"

namespace petzval::apps {

/// Keywords with their texts, in the order in which they are set.
using Keywords = std::vector<std::pair<std::string, std::string>>;

/// Order that these keywords give. Throws ValueError, also for one that no field has.
[[nodiscard]] RenderOrder order_of(const Keywords&);

/// Keywords in which an order differs from one that asks for nothing.
[[nodiscard]] Keywords keywords_of(const RenderOrder&);

/// Message as Python spells it: ⟨focal-length⟩, a field's name, reads focal_length.
[[nodiscard]] std::string as_keywords(const std::string& message);

}  // namespace petzval::apps
