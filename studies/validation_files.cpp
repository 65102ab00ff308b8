#include "studies/validation_files.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"

namespace bedload {

std::string validation_text(const std::filesystem::path& file) {
  const auto name = file.filename().string();
  const auto found = std::ranges::find(validation_files(), name, &EmbeddedFile::name);
  if (found == validation_files().end())
    throw Error(ErrorKind::not_found, fmt::format("there is no file {} in studies/validation", name));
  return std::string(found->text);
}

}   // namespace bedload
