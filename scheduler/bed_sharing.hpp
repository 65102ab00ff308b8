// One settled bed for many cases: bed.h5 of the bed's directory, put into each case's.
#pragma once

#include <filesystem>

namespace bedload {

bool has_bed(const std::filesystem::path& directory);

/// A hard link: the file is never changed once it is published, and the case then needs nothing outside its directory. A
/// durable copy where the file system cannot link. Throws Error io, not_found.
void share_bed(const std::filesystem::path& bed_directory, const std::filesystem::path& case_directory);

}   // namespace bedload
