# cmake -DOUTPUT=file.cpp -DFOLDER=shaders -DFILES="a.glsl,b.glsl" -P embed_shaders.cmake
# writes a C++ source that holds the text of each shader file as a raw string literal.
string(REPLACE "," ";" files "${FILES}")
set(text "#include \"render/gl/shader.h\"\n\nnamespace rubble {\n\nconst ShaderFile kShaderFiles[] = {\n")
foreach(name ${files})
  file(READ "${FOLDER}/${name}" body)
  string(APPEND text "    {\"${name}\", R\"GLSL(${body})GLSL\"},\n")
endforeach()
string(APPEND text "    {nullptr, nullptr}};\n\n}  // namespace rubble\n")
file(WRITE "${OUTPUT}" "${text}")
