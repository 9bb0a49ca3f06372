vs.1.1                          ; a half component of the direction to a lamp
; c0: matrix, c4: lamp, c5: which half component, c6: 0
m4x4 oPos, v0, c0
mov oT0.xy, v7.xy
add r0.xyz, c4.xyz, -v0.xyz
dp3 r0.w, r0.xyz, r0.xyz
rsq r0.w, r0.w
mul r0.xyz, r0.xyz, r0.w
dp3 r1, r0.xyz, c5.xyz
max oD0, r1, c6
