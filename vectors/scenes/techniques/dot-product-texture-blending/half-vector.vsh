vs.1.1                          ; the half vector, not of unit length: the direction to the viewer at unit length, plus that to the light
; c0: matrix, c4: viewer, c5: toward the light, of unit length
m4x4 oPos, v0, c0
mov oT0.xyz, v7.xyz
add r0.xyz, c4.xyz, -v0.xyz
dp3 r0.w, r0.xyz, r0.xyz
rsq r0.w, r0.w
mul r0.xyz, r0.xyz, r0.w
add oT1.xyz, r0.xyz, c5.xyz
