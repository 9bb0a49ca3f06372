vs.1.1                          ; diffuse light of a vertex
; c0: matrix, c4: toward the light, c5: 0
m4x4 oPos, v0, c0
dp3 r0, v3, c4
max oD0, r0, c5
