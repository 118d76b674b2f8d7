// SPDX-License-Identifier: Apache-2.0
#include "io/base/json_parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "io/base/error.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// Line and column of a byte of the text, which is counted from 0.
std::string place_of(std::string_view text, size_t byte) {
    const std::string_view before = text.substr(0, byte);
    const size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
    return fmt::format("line {}, column {}", 1 + std::count(before.begin(), before.end(), '\n'),
                       1 + before.size() - line_start);
}

/// Reads the text for the parser and keeps where it is. The parser holds copies, so that the place
/// is kept outside.
class Reader {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    Reader(const char* at, const char*& furthest) : at_(at), furthest_(&furthest) {}
    reference operator*() const { return *at_; }
    Reader& operator++() {
        *furthest_ = ++at_;
        return *this;
    }
    bool operator==(const Reader& other) const { return at_ == other.at_; }

  private:
    const char* at_;
    const char** furthest_;
};

/// Empties a value from its leaves. The library's own destructor asks for memory, and ends the
/// program where there is none.
void release(json& value) {
    if (auto* array = value.get_ptr<json::array_t*>())
        for (; !array->empty(); array->pop_back()) release(array->back());
    if (auto* members = value.get_ptr<json::object_t*>())
        for (; !members->empty(); members->erase(members->begin()))
            release(members->begin()->second);
}

/// Builds the document from the events of the parser, which itself does not recurse. The parser's
/// own callback looks through all elements of an array whenever one ends: a million take minutes.
class Builder {
  public:
    Builder(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    ~Builder() { release(root_); }
    Builder(const Builder&) = delete;
    Builder& operator=(const Builder&) = delete;

    [[nodiscard]] json parse() {
        const char* const end = text_.data() + text_.size();
        json::sax_parse(Reader(text_.data(), furthest_), Reader(end, furthest_), this);
        return std::move(root_);
    }

    bool null() { return put(nullptr); }
    bool boolean(bool value) { return put(value); }
    bool number_integer(int64_t value) { return put(value); }
    bool number_unsigned(uint64_t value) { return put(value); }
    bool number_float(double value, const std::string&) {
        if (std::abs(value) <= 0x1p53 && value == std::floor(value)) return put(int64_t(value));
        return put(value);
    }
    bool string(std::string& value) { return put(std::move(value)); }
    bool binary(json::binary_t&) { return false; }  // not in a text

    bool start_object(size_t) { return open(json::object()); }
    bool start_array(size_t) { return open(json::array()); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }

    bool key(std::string& key) {
        auto& members = open_.back()->get_ref<json::object_t&>();
        const auto [member, is_new] = members.try_emplace(key);
        if (!is_new)
            throw InputError(file_, place_of(text_, size_t(furthest_ - text_.data()) - 1),
                             "the key that ends here stands in its object already");
        member_ = &member->second;
        return true;
    }

    [[noreturn]] bool parse_error(size_t byte, const std::string& token,
                                  const json::exception& error) const {
        constexpr int number_overflow = 406;
        if (error.id == number_overflow)
            throw InputError(file_, place_of(text_, byte - std::min(byte, token.size())),
                             "the number is beyond the range of a double");
        throw InputError(file_, place_of(text_, std::max<size_t>(byte, 1) - 1),
                         "is not valid JSON from here on");
    }

  private:
    json* place(json value) {
        if (open_.empty()) return &(root_ = std::move(value));
        if (!open_.back()->is_array()) return &(*member_ = std::move(value));
        open_.back()->push_back(std::move(value));
        return &open_.back()->back();
    }
    bool put(json value) {
        place(std::move(value));
        return true;
    }
    bool open(json container) {
        if (open_.size() >= max_json_depth)
            throw InputError(file_, "", "JSON is nested more than {} levels deep; flatten it",
                             max_json_depth);
        open_.push_back(place(std::move(container)));
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    std::string_view text_;
    const std::string& file_;
    const char* furthest_ = text_.data();  ///< behind what is read of the text
    json root_;
    std::vector<json*> open_;  ///< objects and arrays that have not ended, the innermost last
    json* member_ = nullptr;   ///< value of the last key
};

}  // namespace

json parse_json(std::string_view text, const std::string& file) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte order mark
    return Builder(text, file).parse();
}

const nlohmann::json& member(const nlohmann::json& owner, const char* key) {
    static const nlohmann::json none;
    const auto at = owner.is_object() ? owner.find(key) : owner.end();
    return at == owner.end() ? none : *at;
}

std::string text_of(const nlohmann::json& owner, const char* key) {
    const nlohmann::json& text = member(owner, key);
    return text.is_string() ? text.get<std::string>() : std::string();
}

}  // namespace petzval::io
