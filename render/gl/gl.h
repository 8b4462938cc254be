// The OpenGL 4.5 core entry points in use, looked up at run time so that a machine without a
// driver gets a message instead of a program that does not start. Internal to render/.
#pragma once

#include <GL/glcorearb.h>

#include <cstdint>

namespace rubble {

#define RUBBLE_GL_FUNCTIONS(X)                                  \
  X(BindBufferBase, BINDBUFFERBASE)                             \
  X(BindBuffer, BINDBUFFER)                                     \
  X(BindFramebuffer, BINDFRAMEBUFFER)                           \
  X(BindImageTexture, BINDIMAGETEXTURE)                         \
  X(BindTextureUnit, BINDTEXTUREUNIT)                           \
  X(BindVertexArray, BINDVERTEXARRAY)                           \
  X(CheckNamedFramebufferStatus, CHECKNAMEDFRAMEBUFFERSTATUS)   \
  X(ClearNamedBufferData, CLEARNAMEDBUFFERDATA)                 \
  X(ClearNamedFramebufferfv, CLEARNAMEDFRAMEBUFFERFV)           \
  X(ClearNamedFramebufferuiv, CLEARNAMEDFRAMEBUFFERUIV)         \
  X(ClipControl, CLIPCONTROL)                                   \
  X(ClientWaitSync, CLIENTWAITSYNC)                             \
  X(CompileShader, COMPILESHADER)                               \
  X(CopyImageSubData, COPYIMAGESUBDATA)                         \
  X(CopyNamedBufferSubData, COPYNAMEDBUFFERSUBDATA)             \
  X(CreateBuffers, CREATEBUFFERS)                               \
  X(CreateFramebuffers, CREATEFRAMEBUFFERS)                     \
  X(CreateProgram, CREATEPROGRAM)                               \
  X(CreateShader, CREATESHADER)                                 \
  X(CreateTextures, CREATETEXTURES)                             \
  X(CreateVertexArrays, CREATEVERTEXARRAYS)                     \
  X(CullFace, CULLFACE)                                         \
  X(DeleteBuffers, DELETEBUFFERS)                               \
  X(DeleteFramebuffers, DELETEFRAMEBUFFERS)                     \
  X(DeleteProgram, DELETEPROGRAM)                               \
  X(DeleteShader, DELETESHADER)                                 \
  X(DeleteSync, DELETESYNC)                                     \
  X(DeleteTextures, DELETETEXTURES)                             \
  X(DeleteVertexArrays, DELETEVERTEXARRAYS)                     \
  X(DepthFunc, DEPTHFUNC)                                       \
  X(DepthMask, DEPTHMASK)                                       \
  X(Disable, DISABLE)                                           \
  X(DispatchCompute, DISPATCHCOMPUTE)                           \
  X(DispatchComputeIndirect, DISPATCHCOMPUTEINDIRECT)           \
  X(DrawArrays, DRAWARRAYS)                                     \
  X(DrawArraysIndirect, DRAWARRAYSINDIRECT)                     \
  X(Enable, ENABLE)                                             \
  X(EnableVertexArrayAttrib, ENABLEVERTEXARRAYATTRIB)           \
  X(FenceSync, FENCESYNC)                                       \
  X(Flush, FLUSH)                                               \
  X(FrontFace, FRONTFACE)                                       \
  X(GenTextures, GENTEXTURES)                                   \
  X(GenerateTextureMipmap, GENERATETEXTUREMIPMAP)               \
  X(GetError, GETERROR)                                         \
  X(GetIntegerv, GETINTEGERV)                                   \
  X(GetProgramInfoLog, GETPROGRAMINFOLOG)                       \
  X(GetProgramiv, GETPROGRAMIV)                                 \
  X(GetShaderInfoLog, GETSHADERINFOLOG)                         \
  X(GetShaderiv, GETSHADERIV)                                   \
  X(GetString, GETSTRING)                                       \
  X(GetStringi, GETSTRINGI)                                     \
  X(GetTextureImage, GETTEXTUREIMAGE)                           \
  X(GetTextureSubImage, GETTEXTURESUBIMAGE)                     \
  X(GetUniformBlockIndex, GETUNIFORMBLOCKINDEX)                 \
  X(GetUniformLocation, GETUNIFORMLOCATION)                     \
  X(LinkProgram, LINKPROGRAM)                                   \
  X(AttachShader, ATTACHSHADER)                                 \
  X(MapNamedBufferRange, MAPNAMEDBUFFERRANGE)                   \
  X(MemoryBarrier, MEMORYBARRIER)                               \
  X(MultiDrawElementsIndirect, MULTIDRAWELEMENTSINDIRECT)       \
  X(NamedBufferData, NAMEDBUFFERDATA)                           \
  X(NamedBufferStorage, NAMEDBUFFERSTORAGE)                     \
  X(NamedBufferSubData, NAMEDBUFFERSUBDATA)                     \
  X(NamedFramebufferDrawBuffers, NAMEDFRAMEBUFFERDRAWBUFFERS)   \
  X(NamedFramebufferReadBuffer, NAMEDFRAMEBUFFERREADBUFFER)     \
  X(NamedFramebufferTexture, NAMEDFRAMEBUFFERTEXTURE)           \
  X(NamedFramebufferTextureLayer, NAMEDFRAMEBUFFERTEXTURELAYER) \
  X(PixelStorei, PIXELSTOREI)                                   \
  X(ProgramUniform1i, PROGRAMUNIFORM1I)                         \
  X(ProgramUniform2i, PROGRAMUNIFORM2I)                         \
  X(ProgramUniform4f, PROGRAMUNIFORM4F)                         \
  X(ProgramUniform4i, PROGRAMUNIFORM4I)                         \
  X(ReadPixels, READPIXELS)                                     \
  X(Scissor, SCISSOR)                                           \
  X(ShaderSource, SHADERSOURCE)                                 \
  X(TextureBuffer, TEXTUREBUFFER)                               \
  X(TextureParameteri, TEXTUREPARAMETERI)                       \
  X(TextureStorage1D, TEXTURESTORAGE1D)                         \
  X(TextureStorage2D, TEXTURESTORAGE2D)                         \
  X(TextureStorage3D, TEXTURESTORAGE3D)                         \
  X(TextureSubImage1D, TEXTURESUBIMAGE1D)                       \
  X(TextureSubImage2D, TEXTURESUBIMAGE2D)                       \
  X(TextureSubImage3D, TEXTURESUBIMAGE3D)                       \
  X(TextureView, TEXTUREVIEW)                                   \
  X(UniformBlockBinding, UNIFORMBLOCKBINDING)                   \
  X(UseProgram, USEPROGRAM)                                     \
  X(VertexArrayAttribBinding, VERTEXARRAYATTRIBBINDING)         \
  X(VertexArrayAttribFormat, VERTEXARRAYATTRIBFORMAT)           \
  X(VertexArrayAttribIFormat, VERTEXARRAYATTRIBIFORMAT)         \
  X(VertexArrayBindingDivisor, VERTEXARRAYBINDINGDIVISOR)       \
  X(VertexArrayElementBuffer, VERTEXARRAYELEMENTBUFFER)         \
  X(VertexArrayVertexBuffer, VERTEXARRAYVERTEXBUFFER)           \
  X(Viewport, VIEWPORT)

// Since the context was made.
struct GlTraffic {
  std::uint64_t given = 0, taken = 0;  // to the card and back; unit: byte
  std::uint64_t waits = 0;             // of the processor for the card
  std::uint64_t asked = 0, done = 0;   // numbers of what was asked of the card last, and of what it is known to have done
};

// The functions of one context. GL is a set of calls on a current context, so the table is const.
struct Gl {
#define RUBBLE_GL_MEMBER(name, upper) PFNGL##upper##PROC name = nullptr;
  RUBBLE_GL_FUNCTIONS(RUBBLE_GL_MEMBER)
#undef RUBBLE_GL_MEMBER
  // Of GL_ARB_indirect_parameters, which OpenGL has from 4.6 on.
  PFNGLMULTIDRAWELEMENTSINDIRECTCOUNTARBPROC MultiDrawElementsIndirectCount = nullptr;
  GlTraffic* traffic = nullptr;  // never null in a context; counted by gl_traffic.h
};

}  // namespace rubble
