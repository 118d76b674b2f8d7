// SPDX-License-Identifier: Apache-2.0
// Pictures of a sequence: an order for each.
#pragma once

#include <string>
#include <vector>

#include "apps/request/render_order.h"

namespace petzval::apps {

/// One picture of a sequence: how its order differs from that of all.
struct SequenceItem {
    int number;         ///< in the names of its files
    std::string label;  ///< "frame 12", "fstop 1.4"
    std::string field, value;
};

/// Pictures that are asked for. Throws ValueError where a sweep is over what is the same for all.
[[nodiscard]] std::vector<SequenceItem> items_of(const SequenceRequest&);

/// Order of one of several pictures: all's, with what is its own. Throws ValueError, also where
/// pictures would share the names of their files.
[[nodiscard]] RenderOrder order_of(const SequenceItem&, const RenderOrder& all, bool several);

}  // namespace petzval::apps
