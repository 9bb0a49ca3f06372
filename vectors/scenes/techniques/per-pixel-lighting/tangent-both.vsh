vs.1.1                          ; light and half vector in tangent space: as colours and as coordinates
; c0: world, view and projection, c12: toward the light, of unit length, c14: viewer, c20: one half
m4x4 oPos, v0, c0
dp3 r6.x, v8, c12
dp3 r6.y, v9, c12
dp3 r6.z, v3, c12
add r2.xyz, c14.xyz, -v0.xyz
dp3 r2.w, r2.xyz, r2.xyz
rsq r2.w, r2.w
mad r2.xyz, r2.xyz, r2.w, c12.xyz
dp3 r2.w, r2.xyz, r2.xyz
rsq r2.w, r2.w
mul r2.xyz, r2.xyz, r2.w
dp3 r8.x, v8, r2
dp3 r8.y, v9, r2
dp3 r8.z, v3, r2
mad oD0.xyz, r6.xyz, c20.xyz, c20.xyz
mad oD1.xyz, r8.xyz, c20.xyz, c20.xyz
mov oT0.xy, v7.xy
mov oT1.xyz, r6.xyz
mov oT2.xyz, r8.xyz
