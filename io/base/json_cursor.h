// SPDX-License-Identifier: Apache-2.0
// A JSON value that knows where it stands, so that every check is one line and every error names
// its place.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace petzval::io {

/// Range of a number, both ends included.
struct Range {
    double low = -std::numeric_limits<float>::max();
    double high = std::numeric_limits<float>::max();
};

/// A view of one JSON object inside a document that outlives it. Every getter throws InputError
/// with the JSON path when a value is absent though required, or is not of the type asked for.
class JsonCursor {
  public:
    /// file: name of the document, for errors; it must outlive the cursor. Throws when value is
    /// not an object.
    JsonCursor(const nlohmann::json& value, const std::string& file, std::string path = "");

    [[nodiscard]] const nlohmann::json& value() const { return *value_; }
    [[nodiscard]] const std::string& path() const { return path_; }  ///< "" for the root
    [[nodiscard]] std::string path_of(std::string_view key) const;
    [[noreturn]] void fail(const std::string& message) const;
    [[noreturn]] void fail(std::string_view key, const std::string& message) const;
    /// With a message that holds values: as fmt::format() takes it.
    template <class Value, class... More>
    [[noreturn]] void fail(std::string_view key, fmt::format_string<Value, More...> message,
                           Value&& value, More&&... more) const {
        fail(key, fmt::format(message, std::forward<Value>(value), std::forward<More>(more)...));
    }

    [[nodiscard]] bool has(const char* key) const { return value_->contains(key); }
    void require(const char* key) const;

    /// The object at key.
    [[nodiscard]] JsonCursor object(const char* key) const;
    [[nodiscard]] std::optional<JsonCursor> find_object(const char* key) const;
    /// The extension of this object by that name, if it has it.
    [[nodiscard]] std::optional<JsonCursor> extension(const char* name) const;
    /// The objects in the array at key; none where it is absent.
    [[nodiscard]] std::vector<JsonCursor> objects(const char* key) const;
    /// Number of elements in the array at key; 0 where it is absent.
    [[nodiscard]] size_t length(const char* key) const;

    /// A whole number from 0 to 2^53.
    [[nodiscard]] uint64_t integer(const char* key) const;
    [[nodiscard]] uint64_t integer_or(const char* key, uint64_t otherwise) const;
    /// A number that a float can hold, within range.
    [[nodiscard]] double number(const char* key, Range = {}) const;
    [[nodiscard]] double number_or(const char* key, double otherwise, Range = {}) const;
    /// Numbers in the array at key, exactly `count`, each within range; empty where it is absent.
    [[nodiscard]] std::vector<double> numbers(const char* key, size_t count, Range = {}) const;
    [[nodiscard]] std::string text(const char* key) const;
    [[nodiscard]] std::string text_or(const char* key, const char* otherwise) const;
    void check_bool(const char* key) const;

    /// Index at key, if present; must be below `count`. what: the kind of thing counted, "accessor"
    /// say.
    [[nodiscard]] std::optional<size_t> index(const char* key, size_t count,
                                              const char* what) const;
    [[nodiscard]] size_t required_index(const char* key, size_t count, const char* what) const;
    /// Indices in the array at key, all different; none where it is absent.
    [[nodiscard]] std::vector<size_t> indices(const char* key, size_t count,
                                              const char* what) const;

  private:
    [[nodiscard]] const nlohmann::json* find(const char* key) const;
    [[nodiscard]] const nlohmann::json* find_array(const char* key) const;
    [[nodiscard]] std::string element_path(std::string_view key, size_t i) const;
    // place() makes the text of a place: most values are right and need none.
    template <class Place>
    [[nodiscard]] uint64_t as_integer(const nlohmann::json&, const Place& place) const;
    template <class Place>
    [[nodiscard]] double as_number(const nlohmann::json&, const Place& place, Range) const;
    template <class Place>
    [[nodiscard]] size_t as_index(const nlohmann::json&, const Place& place, size_t count,
                                  const char* what) const;

    const nlohmann::json* value_;
    const std::string* file_;
    std::string path_;
};

}  // namespace petzval::io
