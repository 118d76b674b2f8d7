// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

#include "io/base/error.h"

namespace petzval::apps {

/// Value that an option cannot take, or options that do not go together. what() reads "OPTION:
/// WHY".
class ValueError : public io::ArgumentError {
  public:
    ValueError(std::string option, std::string why)
        : io::ArgumentError(option, "", why), option_(std::move(option)), why_(std::move(why)) {}

    [[nodiscard]] const std::string& option() const { return option_; }
    [[nodiscard]] const std::string& why() const { return why_; }

  private:
    std::string option_, why_;
};

}  // namespace petzval::apps
