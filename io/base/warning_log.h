// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace petzval::io {

/// Warnings of a reader, one line each. Lines that differ in their numbers and quoted words only
/// are one warning: the first is kept, the others are counted. So a file with a million faults of
/// one kind gives one line and takes no memory for the others.
class WarningLog {
  public:
    void push_back(std::string line);
    /// The line "place: what".
    void add(const std::string& place, const std::string& what) { push_back(place + ": " + what); }
    /// With words that hold values: as fmt::format() takes them.
    template <class Value, class... More>
    void add(const std::string& place, fmt::format_string<Value, More...> what, Value&& value,
             More&&... more) {
        add(place, fmt::format(what, std::forward<Value>(value), std::forward<More>(more)...));
    }
    [[nodiscard]] bool empty() const { return first_.empty(); }
    /// The warnings in order; one that was met again ends with how often.
    [[nodiscard]] std::vector<std::string> lines() const;

  private:
    std::vector<std::string> first_;
    std::vector<uint64_t> more_;              ///< how many others were like it
    std::map<std::string, size_t> by_shape_;  ///< place in first_
};

}  // namespace petzval::io
