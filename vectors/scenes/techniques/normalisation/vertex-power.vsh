vs.1.1                          ; the highlight at the vertex: (N.H)^8
; c0: world, view and projection, c5: half vector, c6: zero
m4x4 oPos, v0, c0
dp3 r0, v3, c5
max r0, r0, c6
mul r0, r0, r0
mul r0, r0, r0
mul oD0, r0, r0
