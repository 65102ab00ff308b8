# Run at every build: the commit may have moved since the build tree was configured.
execute_process(
  COMMAND git -C ${source_dir} describe --always --dirty --abbrev=12 --exclude=*
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
configure_file(${source_dir}/base/build_info.cpp.in ${output} @ONLY)
