Require Import Reals Lra Field.
Open Scope R_scope.

Lemma root_is : forall u v : R, 0 <= v -> v * v = u -> sqrt u = v.
Proof. intros u v H E. rewrite <- E. apply sqrt_square; exact H. Qed.
Lemma cos_of_asin : forall u : R, -1 <= u <= 1 -> cos (asin u) = sqrt (1 - u ^ 2).
Proof. intros u H. rewrite (cos_asin u H). unfold Rsqr. f_equal; ring. Qed.

Ltac product := repeat first
  [ assumption | apply PI_neq0 | apply Rmult_integral_contrapositive_currified | apply pow_nonzero
  | apply Rinv_neq_0_compat | lra | solve [ apply Rgt_not_eq; unfold Rpower; apply exp_pos ] ].
Ltac nonzero := repeat split; first
  [ assumption
  | solve [ product ]
  | let Z := fresh in intro Z; first
    [ match goal with Z : ?f = 0, h : ?e <> 0 |- False => apply h; replace e with f by ring; exact Z end
    | match goal with Z : ?f = 0, h : ?d <> 0, k : ?e <> 0 |- False =>
        apply (Rmult_integral_contrapositive_currified d e h k); replace (d * e) with f by ring; exact Z end
    | match goal with h : ?e <> 0 |- False => apply h; lra end ] ].
Ltac strictly := unfold Rpower, Rdiv; repeat first
  [ assumption | apply exp_pos | apply PI_RGT_0 | apply Rmult_lt_0_compat | apply Rinv_0_lt_compat | apply pow_lt
  | apply sqrt_lt_R0 | lra ].
Ltac positive := unfold Rdiv; repeat first
  [ assumption | apply sqrt_pos | apply pow2_ge_0 | apply Rmult_le_pos | apply pow_le | lra
  | solve [ apply Rlt_le; strictly ] ].
Lemma ln_of_pow : forall (n : nat) (x : R), 0 < x -> ln (x ^ n) = INR n * ln x.
Proof.
  induction n; intros x H. { simpl; rewrite ln_1; ring. }
  rewrite S_INR. simpl pow. rewrite ln_mult; [ | exact H | apply pow_lt; exact H ]. rewrite IHn; [ ring | exact H ].
Qed.
Ltac logarithms := unfold Rdiv; apply ln_inv; [ strictly | strictly | ];
  repeat first [ rewrite ln_mult by strictly | rewrite ln_Rinv by strictly | rewrite ln_of_pow by strictly
    | unfold Rpower; rewrite ln_exp | progress rewrite ?ln_1 ]; simpl INR; field; nonzero.
Ltac circles := first
  [ match goal with |- Rpower ?b ?e ^ ?k - ?c = 0 => solve [ apply Rminus_diag_eq; logarithms ] end
  | match goal with |- context [cos ?a] => solve [ generalize (sin2_cos2 a); unfold Rsqr; lra ] end
  | match goal with |- context [sqrt ?u] =>
      solve [ let Q := fresh in assert (Q : 0 <= u) by assumption; generalize (sqrt_sqrt u Q); lra ] end ].
