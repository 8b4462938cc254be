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

Files: app/view/viewer_code.cpp
Copyright: 2010-2019 three.js authors
Comment: three.js as Debian's libjs-three has it, compiled into the program as text and written into the
 pages of `rubble view`.
License: Expat
 Permission is hereby granted, free of charge, to any person obtaining a copy
 of this software and associated documentation files (the \"Software\"), to deal
 in the Software without restriction, including without limitation the rights
 to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
 copies of the Software, and to permit persons to whom the Software is
 furnished to do so, subject to the following conditions:
 .
 The above copyright notice and this permission notice shall be included in
 all copies or substantial portions of the Software.
 .
 THE SOFTWARE IS PROVIDED \"AS IS\", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
 IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
 FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
 AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
 LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
 OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
 THE SOFTWARE.
")
write_output(rubble.lua check --annotations)  # last: the build looks at its time
