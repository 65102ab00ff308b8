// One value of a study file, checked against its key.
#pragma once

#include <optional>
#include <string>

#include "studies/study_keys.hpp"
#include "studies/study_node.hpp"

namespace bedload {

/// The value of `key`, called `name` in messages ("grains.diameter[2]"). What is wrong with it is reported; then there is
/// nothing.
std::optional<Setting> read_value(const StudyKey&, const std::string& name, const StudyNode&, Problems&);

/// Where a value of a list stands: "grains.diameter[2]", counted from 1.
std::string indexed(std::string_view path, std::size_t number);

}   // namespace bedload
