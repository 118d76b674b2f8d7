// SPDX-License-Identifier: Apache-2.0
#include "io/base/json_parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "io/base/error.h"

namespace petzval {
namespace {

using nlohmann::json;

/// Watches the parser, which itself does not recurse, while it builds the document.
class Watch {
  public:
    explicit Watch(const std::string& file) : file_(file) {}

    bool operator()(int depth, json::parse_event_t event, json& parsed) {
        using Event = json::parse_event_t;
        if (event == Event::object_start || event == Event::array_start) enter(depth);
        if (event == Event::object_start) keys_.emplace_back();
        if (event == Event::object_end) keys_.pop_back();
        if (event == Event::key) add_key(parsed.get_ref<const std::string&>());
        if (event == Event::value && parsed.is_number_float()) make_integer(parsed);
        return true;
    }

  private:
    void enter(int depth) const {
        if (depth >= max_json_depth)
            throw InputError(
                file_, "",
                fmt::format("JSON is nested more than {} levels deep; flatten it", max_json_depth));
    }

    void add_key(const std::string& key) {
        if (!keys_.back().insert(key).second)
            throw InputError(file_, "",
                             fmt::format("a JSON object has the key \"{}\" twice", printable(key)));
    }

    static void make_integer(json& number) {
        const double value = number.get<double>();
        if (std::abs(value) <= 0x1p53 && value == std::floor(value)) number = int64_t(value);
    }

    const std::string& file_;
    std::vector<std::set<std::string>> keys_;  ///< of each open object
};

/// Line and column of a byte of the text, which is counted from 0.
std::string place_of(std::string_view text, size_t byte) {
    const std::string_view before = text.substr(0, byte);
    const size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
    return fmt::format("line {}, column {}", 1 + std::count(before.begin(), before.end(), '\n'),
                       1 + before.size() - line_start);
}

/// Offset of the number that overflowed: the first occurrence of what the parser's message quotes.
size_t find_quoted(std::string_view text, std::string_view message) {
    const size_t first = message.find('\'') + 1, last = message.rfind('\'');
    const size_t at = last > first ? text.find(message.substr(first, last - first)) : 0;
    return at == std::string_view::npos ? 0 : at;
}

}  // namespace

std::string printable(std::string_view text) {
    std::string out(text.substr(0, 80));
    for (char& c : out)
        if (uint8_t(c) < 0x20 || c == 0x7F) c = '?';
    return text.size() > 80 ? out + "..." : out;
}

json parse_json(std::string_view text, const std::string& file) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte order mark
    Watch watch(file);
    try {
        return json::parse(text, std::ref(watch));
    } catch (const json::parse_error& error) {
        throw InputError(file, place_of(text, std::max<size_t>(error.byte, 1) - 1),
                         "is not valid JSON from here on");
    } catch (const json::out_of_range& error) {
        throw InputError(file, place_of(text, find_quoted(text, error.what())),
                         "the number is beyond the range of a double");
    }
}

}  // namespace petzval
