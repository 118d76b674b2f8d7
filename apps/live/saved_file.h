// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace petzval::apps {

/// A new folder below that of temporary files, gone with what is in it when this goes. Throws
/// OutputError where there can be none.
class OwnFolder {
  public:
    OwnFolder();
    ~OwnFolder();
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// Bytes of a picture as a writer of files writes it, by a name without folders whose ending says
/// the format: .exr, .png, .jpg. Throws ValueError for another name, InputError where there is no
/// room for it.
[[nodiscard]] std::string saved_file(
    const std::string& name, const std::function<void(const std::filesystem::path&)>& write);

}  // namespace petzval::apps
