# What is installed beside the program and made from it, in OUTPUT.
function(write_output file)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_FILE ${OUTPUT}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(write_gz file)  # without a name and a time: the same bytes every time
  execute_process(COMMAND gzip -9 -n -c ${file} OUTPUT_FILE ${OUTPUT}/${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${OUTPUT})
file(MAKE_DIRECTORY ${OUTPUT}/man1 ${OUTPUT}/plain ${OUTPUT}/bash ${OUTPUT}/zsh)
execute_process(COMMAND ${PROGRAM} manual --all ${OUTPUT}/plain COMMAND_ERROR_IS_FATAL ANY)
file(GLOB pages RELATIVE ${OUTPUT}/plain ${OUTPUT}/plain/*.1)
foreach(page IN LISTS pages)
  write_gz(${OUTPUT}/plain/${page} man1/${page}.gz)
endforeach()
write_output(bash/rubble completion bash)
write_output(zsh/_rubble completion zsh)
set(root ${CMAKE_CURRENT_LIST_DIR}/..)
write_gz(${root}/tools/package/changelog changelog.gz)
file(READ ${root}/LICENSE license)
string(REGEX REPLACE "\n\n" "\n.\n" license "${license}")
string(REGEX REPLACE "\n" "\n " license "${license}")
string(STRIP "${license}" license)
file(WRITE ${OUTPUT}/copyright
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: rubble

Files: *
Copyright: 2026 the Rubble authors
License: BSD-3-Clause
 ${license}
")
write_output(rubble.lua check --annotations)  # last: the build looks at its time
